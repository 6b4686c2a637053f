#include "core/exchange/image_label.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr double margin_px = 3.0;

/// A frame of 200 x 100 px with a PSF that gives labels of 3 px to each side.
RunProducts run() {
  RunProducts run{.clock = Clock(parse_utc("2018-01-21T00:15:00Z"))};
  run.sensors.push_back({.name = "eye", .columns = 200, .rows = 100});
  run.frames.push_back({.sensor = "eye", .frame = 1, .psf_fwhm_px = margin_px / label_margin_fwhm});
  run.frame_index[{"eye", 1}] = 0;
  return run;
}

Truth truth(PixelPosition start, PixelPosition end) {
  Truth t{.sensor = "eye", .frame = 1, .in_frame = true, .whole = true};
  const PixelPosition middle = (start + end) * 0.5;
  t.start_x_px = start.x_px, t.start_y_px = start.y_px;
  t.middle_x_px = middle.x_px, t.middle_y_px = middle.y_px;
  t.end_x_px = end.x_px, t.end_y_px = end.y_px;
  return t;
}

TEST(ImageLabel, BoxHasTheMarginAroundTheTrail) {
  const auto label = label_of(truth({20, 30}, {60, 50}), run());
  ASSERT_TRUE(label);
  EXPECT_DOUBLE_EQ(label->box.left_px, 17);
  EXPECT_DOUBLE_EQ(label->box.top_px, 27);
  EXPECT_DOUBLE_EQ(label->box.right_px, 63);
  EXPECT_DOUBLE_EQ(label->box.bottom_px, 53);
}

TEST(ImageLabel, OutlineIsTheBandAroundTheTrail) {
  const auto label = label_of(truth({20, 30}, {60, 60}), run());  // 50 px long
  EXPECT_NEAR(area_px2(outline_of(*label, 200, 100)), (50 + 2 * margin_px) * 2 * margin_px, 1e-9);
}

TEST(ImageLabel, OutlineOfAPointIsASquare) {
  const auto label = label_of(truth({20, 30}, {20, 30}), run());
  EXPECT_NEAR(area_px2(outline_of(*label, 200, 100)), 4 * margin_px * margin_px, 1e-9);
}

TEST(ImageLabel, EndsAtTheImagesEdge) {
  const auto label = label_of(truth({-20, 50}, {20, 50}), run());
  EXPECT_DOUBLE_EQ(label->box.left_px, -0.5);
  EXPECT_NEAR(area_px2(outline_of(*label, 200, 100)), (20.5 + margin_px) * 2 * margin_px, 1e-9);
}

// 45 deg: the band's corners at the left edge lie 3 sqrt(2) px above and below the trail.
TEST(ImageLabel, BoxOfATrailThatLeavesOnADiagonalEndsWithItsBandInTheImage) {
  const auto label = label_of(truth({-60.5, -10}, {39.5, 90}), run());
  ASSERT_TRUE(label);
  EXPECT_DOUBLE_EQ(label->box.left_px, -0.5);
  EXPECT_NEAR(label->box.top_px, 50 - margin_px * std::sqrt(2.0), 1e-9);
  EXPECT_DOUBLE_EQ(label->box.right_px, 39.5 + margin_px);
  EXPECT_DOUBLE_EQ(label->box.bottom_px, 90 + margin_px);
}

// The box of the whole trail covers the image's corner, the band does not.
TEST(ImageLabel, IsNoneForATrailThatPassesTheCorner) {
  EXPECT_FALSE(label_of(truth({-40, 20}, {20, -40}), run()));
}

TEST(ImageLabel, IsNoneOutsideTheImageAndWithoutLight) {
  EXPECT_FALSE(label_of(truth({-20, 50}, {-10, 50}), run()));
  Truth dark = truth({20, 30}, {60, 50});
  dark.in_frame = false;
  EXPECT_FALSE(label_of(dark, run()));
}

}  // namespace
}  // namespace dmise
