#include "core/detection/source/hidden_ends.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/parallel.h"
#include "core/detection/pixels/filtered_frame.h"
#include "core/detection/source/line_profile.h"
#include "core/detection/source/source_fit.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

constexpr int wide = 64, high = 48;

/// A frame of sky, of which all is hidden: nothing but its edge ends a gap.
struct Hidden {
  FrameHeader header = simulated::camera_header(wide, high, 1663.0, 0.6, 20, true);
  CountImage counts{wide, high, 1000};
  Threads one{1};
  Background background{counts, 64, one};
  StarMotion motion{header, wide, high};
  FilteredFrame all_hidden{wide, high, 1.0};
  Scene scene{counts, background, motion, 1.0, 60000.0, 1.0, false, PsfField::gaussian(2.0)};

  Hidden() { scene.hidden = &all_hidden; }
};

TEST(HiddenEnds, AreNoFartherThanTheFrame) {
  const Hidden hidden;
  const double diagonal_px = hidden.scene.diagonal_px();
  for (const double length_px : {30.0, 1e4, 1e12, 1e300, HUGE_VAL}) {
    const HiddenEnds ends = hidden_ends(
        hidden.scene, {.x_px = 20, .y_px = 20, .length_px = length_px, .angle_rad = 0.3});
    EXPECT_LE(ends.first_px, diagonal_px + 1);
    EXPECT_LE(ends.last_px, diagonal_px + 1);
  }
}

TEST(HiddenEnds, AFitThatHasLeftTheFrameIsNotPlausible) {
  const Hidden hidden;
  const Trail good{.x_px = 20, .y_px = 20, .flux_e = 1000, .length_px = 30};
  EXPECT_TRUE(plausible(hidden.scene, good));
  for (const double value : {1e4, 1e12, 1e300, HUGE_VAL, double(NAN)}) {
    Trail longer = good, bent = good;
    longer.length_px = value;
    bent.sagitta_px = value;
    EXPECT_FALSE(plausible(hidden.scene, longer)) << value;
    EXPECT_FALSE(plausible(hidden.scene, bent)) << value;
  }
}

// A line of any length has as many slices as the frame has columns, or rows.
TEST(HiddenEnds, ALineHasNoSlicesBesideTheFrame) {
  Hidden hidden;
  hidden.scene.hidden = nullptr;
  for (const double length_px : {1e3, 1e9, 1e300}) {
    const Line line = line_of({.x_px = 20, .y_px = 20, .length_px = length_px});
    const Extent extent = extent_of(line, length_px / 2);
    EXPECT_EQ(slices(hidden.scene, line, extent.from, extent.to, 0.0).size(), std::size_t(wide));
  }
}

}  // namespace
}  // namespace dmise
