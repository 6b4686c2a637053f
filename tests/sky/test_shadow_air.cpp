#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/sky/bodies/shadow.h"

namespace dmise {
namespace {

using Edge = EarthShadow::Edge;

constexpr double radius_m = 6371e3;
const Vec<Gcrs> sun_m{0, 0, 1.495978707e11};
const OblateEarth sphere{.ellipsoid = {radius_m, 0.0}};

Band line(double wavelength_nm) { return {"line", wavelength_nm * nm, 1 * nm, {}}; }

Vec<Gcrs> place(double height_m, double across_m) {
  const double r = radius_m + height_m;
  return {across_m, 0, -std::sqrt(r * r - across_m * across_m)};
}

struct Row {
  double height_m, across_m, wavelength_nm, air, limb, even;
};
constexpr Row rows[] = {
#include "tests/sky/shadow_air_reference.inc"
};

// Reference: rays traced through the U.S. Standard Atmosphere, 60,000 points of the Sun
// (tests/reference/shadow_air.py).
TEST(ShadowAir, LightCurvesOfTracedRays) {
  double worst_mag = 0.0;
  for (const Row& row : rows) {
    const EarthShadow shadow(sun_m, sphere, Edge::air, line(row.wavelength_nm));
    const double light = shadow.sunlit_fraction(place(row.height_m, row.across_m));
    if (row.air >= 0.05) {
      const double mag = std::abs(2.5 * std::log10(light / row.air));
      worst_mag = std::max(worst_mag, mag);
      EXPECT_LT(mag, 0.05) << row.height_m << " " << row.across_m << " " << row.wavelength_nm
                           << ": " << light << " " << row.air;
    } else {
      EXPECT_NEAR(light, row.air, 0.004) << row.height_m << " " << row.across_m;
    }
  }
  RecordProperty("worst_mag", std::to_string(worst_mag));
}

TEST(ShadowAir, ALimbThatDarkensAndASharpEdge) {
  for (const Row& row : rows) {
    const Vec<Gcrs> at = place(row.height_m, row.across_m);
    const Band band = line(row.wavelength_nm);
    EXPECT_NEAR(EarthShadow(sun_m, sphere, Edge::limb, band).sunlit_fraction(at), row.limb, 0.002);
    EXPECT_NEAR(EarthShadow(sun_m, sphere, Edge::sharp, band).sunlit_fraction(at), row.even, 0.002);
    EXPECT_EQ(EarthShadow(sun_m, sphere, Edge::sharp, band).sunlit_fraction(at),
              EarthShadow(sun_m, sphere).sunlit_fraction(at));
  }
}

// 33 arcmin of refraction at the horizon, on the way in and out.
TEST(ShadowAir, ARayAlongTheGroundIsBentTwiceByTheRefractionOfTheHorizon) {
  const GrazingAir air(line(550));
  EXPECT_NEAR(air.bending_rad(0.0) / arcmin, 66.0, 4.0);
  EXPECT_NEAR(air.bending_rad(20e3) / arcmin, 5.59, 0.3);
  EXPECT_LT(air.transmission(0.0), 0.001);
  EXPECT_GT(air.transmission(60e3), 0.99);
}

// What is left deep in the penumbra is red.
TEST(ShadowAir, TheLastLightIsRed) {
  const Vec<Gcrs> at = place(35786e3, 6195e3);
  const double blue = EarthShadow(sun_m, sphere, Edge::air, line(450)).sunlit_fraction(at);
  const double red = EarthShadow(sun_m, sphere, Edge::air, line(850)).sunlit_fraction(at);
  EXPECT_GT(red, 1.2 * blue);
}

// Into the shadow at every height, oblate Earth, and beyond the apex of the umbra: continuous and
// monotone.
TEST(ShadowAir, IsContinuousAndMonotoneThroughTheEdge) {
  const Band wide{"wide", 1400 * nm, 2200 * nm, {}};
  for (const OblateEarth& earth : {OblateEarth{}, sphere})
    for (const Edge edge : {Edge::limb, Edge::air})
      for (const double height_m : {150e3, 550e3, 36000e3, 384e6, 1.6e9}) {
        const EarthShadow shadow(sun_m, earth, edge, height_m < 1e6 ? line(656) : wide);
        const double r = earth.ellipsoid.equatorial_radius_m + height_m;
        const double reach = std::min(0.999 * r, 6500e3 + 0.005 * r);
        const int steps = height_m < 1e6 ? 8000 : 1500;
        double last = -1.0;
        for (int i = 0; i <= steps; ++i) {
          const double across = reach * i / steps;
          const double light =
              shadow.sunlit_fraction({across, 0, -std::sqrt(r * r - across * across)});
          ASSERT_TRUE(light >= 0.0 && light <= 1.0) << height_m << " " << across;
          if (last >= 0.0) {
            EXPECT_GE(light, last - 2e-3) << height_m << " " << across;
            EXPECT_LT(light, last + 0.1) << height_m << " " << across;
          }
          last = light;
        }
        EXPECT_EQ(shadow.sunlit_fraction({0, 0, r}), 1.0);
      }
}

}  // namespace
}  // namespace dmise
