#include "core/detection/known/star_motion.h"

#include <gtest/gtest.h>

#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

double trail_px(const StarMotion& motion, double x, double y) {
  const auto d = motion.trail_at({x, y});
  return std::hypot(d.x_px, d.y_px);
}

// 3326 px across 90 deg, long axis north-south, boresight at declination +34, fixed mount, 20 s. By
// hand: a star at declination d moves by 15.041 arcsec/s cos(d); the pixel at the centre spans
// 124.0 arcsec and the gnomonic projection stretches the edges.
TEST(StarMotion, TrailsOfAFixedAllSkyCamera) {
  const auto header = simulated::camera_header(3326, 2504, 1663.0, 34 * deg, 20, true);
  const StarMotion motion(header, 3326, 2504);
  EXPECT_NEAR(trail_px(motion, 1662.5, 1251.5), 2.02, 0.01);
  EXPECT_NEAR(trail_px(motion, 3325, 1251.5), 0.65, 0.01);
  EXPECT_NEAR(trail_px(motion, 0, 1251.5), 3.37, 0.01);
}

TEST(StarMotion, TrackedStarsStandStill) {
  const auto header = simulated::camera_header(3326, 2504, 1663.0, 34 * deg, 20, false);
  EXPECT_NEAR(trail_px(StarMotion(header, 3326, 2504), 100, 200), 0.0, 1e-9);
}

// On the equator h = tan(hour angle) of a place to the west and d = tan(dec) sqrt(1 + h^2) of one
// to the north are a gnomonic frame's coordinates in focal lengths. On a mount at rest h grows by
// 1 + h^2 and d by d h, the most at the corners.
TEST(StarMotion, LongestTrailsOfAWideFrameAreAtItsCorners) {
  const StarMotion motion(simulated::camera_header(3326, 2504, 1663.0, 0.0, 20, true), 3326, 2504);
  const double h = 1251.5 / 1663, d = 1662.5 / 1663;
  const double middle_px = 1663 * 7.292115e-5 * 20;
  EXPECT_NEAR(motion.longest_trail_px(), middle_px * std::hypot(1 + h * h, d * h), 1e-3);
  const auto trails = motion.trails_over_frame();
  EXPECT_NEAR(std::hypot(trails[4].x_px, trails[4].y_px), middle_px, 1e-3);
}

// In every projection a small rotation about the boresight turns the image about its centre.
TEST(StarMotion, RollTurnsTheImageInEveryProjection) {
  auto header = simulated::camera_header(1001, 1001, 600.0, 0, 20, false);
  const double roll_rad = 1e-3;
  const auto rolled = [&](double angle_rad) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const Rotation<CameraFrame, CameraFrame> turn{{{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}}};
    return quaternion_of(turn * rotation_of<CameraFrame, Gcrs>(header.camera_from_gcrs[1]));
  };
  header.camera_from_gcrs = {rolled(-roll_rad / 2), rolled(0), rolled(roll_rad / 2)};
  for (const auto projection : {Projection::gnomonic, Projection::equidistant,
                                Projection::equisolid, Projection::stereographic}) {
    header.projection = projection;
    const auto d = StarMotion(header, 1001, 1001).trail_at({900, 500});
    EXPECT_NEAR(d.x_px, 0.0, 1e-3) << projection.name();
    EXPECT_NEAR(d.y_px, -400 * roll_rad, 1e-5) << projection.name();
  }
}

}  // namespace
}  // namespace dmise
