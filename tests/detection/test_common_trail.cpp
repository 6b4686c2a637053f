#include "core/detection/stars/common_trail.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/support/simulated_frame.h"
#include "tests/support/simulated_scene.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;
using simulated::SimulatedScene;

constexpr int size = 512;
constexpr double sky_e = 1500.0;  // noise of 39.8 e- a pixel

/// An instrument says that it follows the stars: what trails show is in the counts alone.
SimulatedFrame empty_frame(int columns = size, int rows = size) {
  return {camera_header(columns, rows, 1663, 0.0, 400.0, false), columns, rows, sky_e, 5};
}

std::optional<PixelPosition> common_trail_in(SimulatedFrame& frame) {
  return common_trail(SimulatedScene(frame.header(), frame.expose()).scene);
}

/// Adds streaks that are all alike, each by a star's light, to places at random.
void add_trails(int count, double length_px, double angle_rad, SimulatedFrame& frame) {
  for (int i = 0; i < count; ++i) {
    const double x = frame.uniform(0, size), y = frame.uniform(0, size);
    frame.add_streak(x, y, length_px, angle_rad,
                     160 * length_px * std::pow(12.0, frame.uniform(0, 1)));
  }
}

TEST(CommonTrail, IsMeasuredWhereTrailsOverlap) {
  for (const double length_px : {15.0, 48.0, 120.0})
    for (const double angle_rad : {0.0, 0.6, 1.57, 2.5}) {
      SimulatedFrame frame = empty_frame();
      add_trails(200, length_px, angle_rad, frame);
      const auto trail = common_trail_in(frame);
      ASSERT_TRUE(trail) << length_px << " px at " << angle_rad;
      const double x_px = length_px * std::cos(angle_rad), y_px = length_px * std::sin(angle_rad);
      const double sign = trail->x_px * x_px + trail->y_px * y_px < 0 ? -1 : 1;
      EXPECT_NEAR(sign * trail->x_px, x_px, 0.4) << length_px << " px at " << angle_rad;
      EXPECT_NEAR(sign * trail->y_px, y_px, 0.4) << length_px << " px at " << angle_rad;
    }
}

TEST(CommonTrail, IsNotThereWhereStarsArePoints) {
  SimulatedFrame frame = empty_frame();
  for (int i = 0; i < 200; ++i) {
    const double x = frame.uniform(0, size), y = frame.uniform(0, size);
    frame.add_point(x, y, 8000 * std::pow(12.0, frame.uniform(0, 1)));
  }
  EXPECT_FALSE(common_trail_in(frame));
}

TEST(CommonTrail, IsNotThereWhereStreaksHaveNothingInCommon) {
  SimulatedFrame frame = empty_frame();
  for (int i = 0; i < 200; ++i)
    add_trails(1, frame.uniform(15, 120), frame.uniform(0, 3.14), frame);
  EXPECT_FALSE(common_trail_in(frame));
}

TEST(CommonTrail, IsNotThereInAnEmptySky) {
  SimulatedFrame frame = empty_frame();
  EXPECT_FALSE(common_trail_in(frame));
}

TEST(CommonTrail, IsNotThereInFramesTooSmallForIt) {
  for (const auto& [columns, rows] : {std::pair{1, 1}, {3, 5}, {1, 300}, {300, 1}, {7, 9}}) {
    SimulatedFrame frame = empty_frame(columns, rows);
    frame.add_streak(columns / 2.0, rows / 2.0, 20, 0.6, 1e5);
    EXPECT_FALSE(common_trail_in(frame)) << columns << " x " << rows;
  }
}

}  // namespace
}  // namespace dmise
