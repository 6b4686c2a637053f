#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/optics/projection.h"

namespace dmise {
namespace {

const Projection projections[] = {Projection::gnomonic, Projection::equidistant,
                                  Projection::equisolid, Projection::stereographic};

// The paper's all-sky camera: 90 deg across 3326 pixels of 5.4 um.
Optics all_sky(Projection projection) {
  return {.projection = projection,
          .focal_length_m = 8.9802e-3,
          .aperture_m = 0.0375,
          .pixel_pitch_m = 5.4e-6,
          .columns = 3326,
          .rows = 2504,
          .equivalent_aperture = true};
}

TEST(Projection, TheBoresightMeetsTheCentreOfTheImage) {
  for (Projection p : projections) {
    const auto pixel = project(all_sky(p), {0, 0, 2.0});
    ASSERT_TRUE(pixel);
    EXPECT_EQ(*pixel, (PixelPosition{1662.5, 1251.5}));
  }
}

// Reference: the definitions of the four image heights at 40 deg, x to the right and y down.
TEST(Projection, ImageHeightIsThatOfTheNamedProjection) {
  const double theta = 40 * deg, f = all_sky(Projection::gnomonic).focal_length_px();
  const double heights[] = {f * std::tan(theta), f * theta, 2 * f * std::sin(theta / 2),
                            2 * f * std::tan(theta / 2)};
  for (int i = 0; i < 4; ++i) {
    const auto pixel = project(all_sky(projections[i]),
                               {std::sin(theta) * 0.6, std::sin(theta) * 0.8, std::cos(theta)});
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x_px - 1662.5, 0.6 * heights[i], 1e-9);
    EXPECT_NEAR(pixel->y_px - 1251.5, 0.8 * heights[i], 1e-9);
  }
}

TEST(Projection, ThereAndBackOverTheFrameAndFarOutside) {
  for (Projection p : projections)
    for (double x : {-5000.0, -0.5, 0.0, 100.25, 1662.5, 1662.5 + 1e-7, 3325.5})
      for (double y : {-0.5, 1251.5, 2503.5, 2000.0}) {
        const auto direction = unproject(all_sky(p), {x, y});
        if (!direction) continue;
        EXPECT_NEAR(norm(*direction), 1.0, 1e-14);
        const auto back = project(all_sky(p), *direction);
        ASSERT_TRUE(back);
        EXPECT_NEAR(back->x_px, x, 1e-8);
        EXPECT_NEAR(back->y_px, y, 1e-8);
      }
}

TEST(Projection, NothingBehindTheCameraIsWrappedIntoTheImage) {
  EXPECT_FALSE(project(all_sky(Projection::gnomonic), {0.1, 0.0, -1.0}));
  EXPECT_FALSE(project(all_sky(Projection::gnomonic), {1.0, 0.0, 0.0}));
  for (Projection p : projections) EXPECT_FALSE(project(all_sky(p), {0.0, 0.0, -1.0})) << p.name();
  for (Projection p : {Projection::equidistant, Projection::equisolid, Projection::stereographic}) {
    const auto pixel = project(all_sky(p), {std::sin(170 * deg), 0.0, std::cos(170 * deg)});
    ASSERT_TRUE(pixel);
    EXPECT_GT(pixel->x_px, 3326) << p.name();
  }
  const double f = all_sky(Projection::equisolid).focal_length_px();
  EXPECT_FALSE(unproject(all_sky(Projection::equisolid), {1662.5 + 2.001 * f, 1251.5}));
  EXPECT_FALSE(unproject(all_sky(Projection::equidistant), {1662.5 + 3.142 * f, 1251.5}));
}

// Reference: the corners' directions, spherical excess of the pixel by Van Oosterom & Strackee
// 1983.
TEST(Projection, PixelSolidAngleIsThatOfItsCorners) {
  for (Projection p : projections)
    for (PixelPosition at : {PixelPosition{1662.5, 1251.5}, {0, 0}, {3325, 1251}, {700, 2400}}) {
      const Optics o = all_sky(p);
      const auto corner = [&](double dx, double dy) {
        return *unproject(o, at + PixelPosition{dx, dy});
      };
      const auto a = corner(-0.5, -0.5), b = corner(0.5, -0.5), c = corner(0.5, 0.5),
                 d = corner(-0.5, 0.5);
      const auto triangle = [](const auto& u, const auto& v, const auto& w) {
        return 2 * std::atan2(dot(u, cross(v - u, w - u)), 1 + dot(u, v) + dot(v, w) + dot(w, u));
      };
      const double expected = triangle(a, b, c) + triangle(a, c, d);
      EXPECT_NEAR(pixel_solid_angle_sr(o, at) / expected, 1.0, 2e-6) << p.name();
    }
}

TEST(Projection, FieldOfThePapersCameraIs90DegAcross) {
  const auto left = unproject(all_sky(Projection::gnomonic), {-0.5, 1251.5});
  const auto right = unproject(all_sky(Projection::gnomonic), {3325.5, 1251.5});
  EXPECT_NEAR(angle_rad(*left, *right), 90 * deg, 0.001 * deg);
}

TEST(Camera, AFocalRatioBelowOneHalfNeedsAnEquivalentAperture) {
  Optics o = all_sky(Projection::gnomonic);
  EXPECT_NO_THROW(check(o));
  o.equivalent_aperture = false;
  EXPECT_THROW(check(o), ConfigError);
  o.aperture_m = 0.017;
  EXPECT_NO_THROW(check(o));
  o.columns = 0;
  EXPECT_THROW(check(o), ConfigError);
}

}  // namespace
}  // namespace dmise
