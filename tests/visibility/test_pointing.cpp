#include "core/visibility/pointing.h"

#include <gtest/gtest.h>

#include "core/base/units.h"

namespace dmise {
namespace {

const Vec<CameraFrame> boresight{0, 0, 1}, up{0, -1, 0}, right{1, 0, 0};

TEST(Pointing, SeenFromInsideNorthIsUpAndEastIsLeft) {
  const auto gcrs_from_camera = camera_at<Gcrs>(50 * deg, 20 * deg, 0).inverse();
  EXPECT_LT(angle_rad(gcrs_from_camera * boresight, from_spherical<Gcrs>(50 * deg, 20 * deg)),
            1e-12);
  EXPECT_GT(to_spherical(gcrs_from_camera * (boresight + up * 0.01))[1], 20 * deg);
  EXPECT_LT(to_spherical(gcrs_from_camera * (boresight + right * 0.01))[0], 50 * deg);
}

TEST(Pointing, IsARotationAtThePole) {
  const auto r = camera_at<Gcrs>(30 * deg, 90 * deg, 0).inverse();
  EXPECT_NEAR((r * boresight).z, 1.0, 1e-12);
  EXPECT_NEAR(dot(cross(r * right, r * -up), r * boresight), 1.0, 1e-12);
}

/// ENU direction of a camera axis for a ground sensor on an Earth that is not turned.
Vec<Enu> on_the_ground(const Pointing& pointing, double roll_deg, const Vec<CameraFrame>& axis) {
  const Site site{40.0, -70.0, 0.0};
  const SensorConfig sensor{.pointing = pointing, .roll_deg = roll_deg};
  PointingScene scene;
  scene.site = &site;
  return enu_from_itrs(site) * (scene.itrs_from_gcrs * (aim(sensor, scene).inverse() * axis));
}

TEST(Pointing, AtTheZenithNorthIsUpAndRollTurnsItEast) {
  EXPECT_NEAR(on_the_ground(PointUp{}, 0, boresight).z, 1.0, 1e-12);
  EXPECT_NEAR(on_the_ground(PointUp{}, 0, up).y, 1.0, 1e-12);
  EXPECT_NEAR(on_the_ground(PointUp{}, 90, up).x, 1.0, 1e-12);
}

TEST(Pointing, OnTheHorizonsGridTheZenithIsUpAndRollFollowsAzimuth) {
  const PointHorizon south{180.0, 30.0};
  EXPECT_NEAR(on_the_ground(south, 0, boresight).y, -std::cos(30 * deg), 1e-12);
  EXPECT_NEAR(on_the_ground(south, 0, up).z, std::cos(30 * deg), 1e-12);
  EXPECT_NEAR(on_the_ground(south, 90, up).x, -1.0, 1e-12);  // west, where azimuth grows
}

}  // namespace
}  // namespace dmise
