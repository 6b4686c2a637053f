#include "core/visibility/pointing.h"

#include <gtest/gtest.h>

#include "core/base/units.h"
#include "tests/visibility/watch.h"

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

/// The first passes of the space station through a field of 0.2 deg that follows it.
std::vector<Pass> followed_passes(bool geometric) {
  std::vector<MeanElements> elements;
  for (const MeanElements& e : test::debian_catalogue())
    if (e.catalogue_number == 25544) elements.push_back(e);
  SensorConfig sensor = test::at_atlanta(test::flat_camera(0.2, 0.2));
  sensor.pointing = PointTarget{"25544", geometric};
  sensor.tracking = Tracking::target;
  test::Watch watch(sensor, elements, "2018-01-21T00:00:00Z", 14400, 10, std::nullopt, 0);
  return watch.passes();
}

// As in frames: what is seen at its apparent place stays in the middle; aimed at geometrically it
// stands off the middle by its refraction, which is 6 arcmin (half the field) at 8.9 deg and 8.5
// arcmin (to the corner) at 6.0 deg by Bennett 1982.
TEST(Pointing, ATargetIsInTheFieldOfVisibleAsItIsInFrames) {
  const auto apparent = followed_passes(false), geometric = followed_passes(true);
  ASSERT_FALSE(apparent.empty());
  ASSERT_EQ(apparent.size(), geometric.size());
  EXPECT_NEAR(apparent[0].rise.horizontal->elevation_rad / deg, 0.0, 0.1);
  EXPECT_GT(geometric[0].rise.horizontal->elevation_rad / deg, 5.8);
  EXPECT_LT(geometric[0].rise.horizontal->elevation_rad / deg, 9.1);
}

}  // namespace
}  // namespace dmise
