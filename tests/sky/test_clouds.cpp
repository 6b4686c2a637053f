#include "core/sky/air/clouds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

TEST(Clouds, AVeilIsThickerTowardsTheHorizon) {
  const CloudMap veil(UniformCloud{0.5});
  EXPECT_DOUBLE_EQ(veil.transmission({0, 0, 1}, 0), 0.5);
  EXPECT_NEAR(veil.transmission({std::sqrt(0.75), 0, 0.5}, 0), std::pow(0.5, 1.89), 0.002);
  EXPECT_GT(veil.transmission({1, 0, -0.1}, 0), 0.0);
  EXPECT_DOUBLE_EQ(CloudMap(UniformCloud{}).transmission({1, 0, 0}, 5), 1.0);
}

TEST(Clouds, PatchesCoverTheirShareOfTheLayer) {
  for (const double cover : {0.0, 0.2, 0.5, 0.8, 1.0}) {
    const CloudMap map(PatchyClouds{.cover = cover, .transmission = 0.0, .seed = 5});
    double clouded = 0;
    int n = 0;
    for (double x = -20; x < 20; x += 0.2)
      for (double y = -20; y < 20; y += 0.2, ++n)
        clouded += 1 - map.transmission(unit(Vec<Enu>{x, y, 1}), 0);
    // Slant paths do not matter for opaque clouds.
    EXPECT_NEAR(clouded / n, cover, 0.04);
  }
}

TEST(Clouds, TheSeedMakesThePattern) {
  const CloudMap one(PatchyClouds{.seed = 1}), same(PatchyClouds{.seed = 1}),
      other(PatchyClouds{.seed = 2});
  int differ = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec<Enu> at = from_spherical<Enu>(0.1 * i, (5 + 0.8 * i) * deg);
    EXPECT_EQ(one.transmission(at, 3), same.transmission(at, 3));
    differ += one.transmission(at, 3) != other.transmission(at, 3);
  }
  EXPECT_GT(differ, 50);
}

TEST(Clouds, DriftWithTheWind) {
  const PatchyClouds opaque{.transmission = 0, .height_m = 3000, .wind_east_m_per_s = 10};
  const CloudMap drifting(opaque);
  EXPECT_NEAR(drifting.transmission(unit(Vec<Enu>{0.1, 0.2, 1}), 0),
              drifting.transmission(unit(Vec<Enu>{1.1, 0.2, 1}), 300), 1e-9);
}

TEST(Clouds, ContinuousWithinTheirRangeAndFinite) {
  const CloudMap map{PatchyClouds{}};
  double last = map.transmission(from_spherical<Enu>(1.0, -5 * deg), 0);
  for (double altitude = -5; altitude <= 185; altitude += 0.002) {
    const double here = map.transmission(from_spherical<Enu>(1.0, altitude * deg), 0);
    EXPECT_TRUE(here >= 0 && here <= 1) << altitude;
    if (altitude > 15 && altitude < 165) {
      EXPECT_NEAR(here, last, 0.05) << altitude;
    }
    last = here;
  }
  EXPECT_THROW(CloudMap(UniformCloud{1.2}), Error);
  EXPECT_THROW(CloudMap(PatchyClouds{.cover = NAN}), Error);
}

}  // namespace
}  // namespace dmise
