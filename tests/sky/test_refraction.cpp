#include "core/sky/air/refraction.h"

#include <erfa.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/sky/places/atmospheric_refraction.h"
#include "core/sky/scattered_moonlight.h"

namespace dmise {
namespace {

constexpr double observer_radius_m = 6371e3;
const Refraction sea_level{standard_weather(0.0)};
const Refraction dry{Weather{.humidity = 0.0}};

// Reference: U.S. Standard Atmosphere 1976, tables I and III.
TEST(Weather, FollowsTheStandardAtmosphere) {
  EXPECT_NEAR(standard_weather(0).pressure_hpa, 1013.25, 0.01);
  EXPECT_NEAR(standard_weather(2000).pressure_hpa, 794.95, 0.3);
  EXPECT_NEAR(standard_weather(2000).temperature_c, 2.0, 0.1);
  EXPECT_NEAR(standard_weather(11000).pressure_hpa, 226.32, 0.2);
  EXPECT_NEAR(standard_weather(20000).pressure_hpa, 54.75, 0.1);
}

// Reference: rays traced through the standard atmosphere, tests/reference/refraction.py: apparent
// zenith angle [deg], refraction of a star, and how much less a body at 550 km is lifted [arcsec].
TEST(Refraction, AgreesWithTracedRays) {
  const struct {
    double zenith_deg, star_arcsec, less_arcsec, star_tolerance, less_tolerance;
  } rows[] = {{20, 20.829, 0.321, 0.01, 0.005}, {45, 57.169, 0.907, 0.02, 0.01},
              {60, 98.789, 1.666, 0.03, 0.01},  {70, 155.887, 2.923, 0.05, 0.02},
              {75, 210.244, 4.387, 0.1, 0.03},  {80, 313.378, 7.900, 0.5, 0.05},
              {85, 579.998, 21.119, 1, 0.3},    {88, 1067.612, 57.599, 2, 2},
              {89.99, 1974.245, 153.332, 4, 10}};
  for (const auto& row : rows) {
    const double apparent = (90 - row.zenith_deg) * deg;
    EXPECT_NEAR(dry.at_apparent_rad(apparent) / arcsec, row.star_arcsec, row.star_tolerance)
        << row.zenith_deg;
    // Distance to a body at 550 km along nearly this elevation.
    const double true_star = dry.true_from_apparent_rad(apparent);
    const double s = observer_radius_m * std::sin(true_star);
    const double distance_m = std::sqrt(s * s + 550e3 * (2 * observer_radius_m + 550e3)) - s;
    const double less = dry.true_from_apparent_rad(apparent, distance_m) - true_star;
    EXPECT_NEAR(less / arcsec, row.less_arcsec, row.less_tolerance) << row.zenith_deg;
  }
}

// Reference: the same rays through other airs, at apparent elevations [deg].
TEST(Refraction, AgreesWithRaysTracedThroughWarmColdAndThinAir) {
  constexpr double elevations_deg[] = {0.001, 0.3, 1, 3, 5, 10};
  const struct {
    double pressure_hpa, temperature_c, star_arcsec[6];
  } rows[] = {{1013.25, -15, {2392.93, 2129.09, 1664.37, 966.02, 656.43, 351.37}},
              {1013.25, 10, {2040.24, 1829.04, 1450.16, 861.72, 591.54, 319.14}},
              {1013.25, 30, {1819.82, 1639.67, 1312.38, 792.25, 547.72, 297.21}},
              {800, 5, {1628.55, 1461.91, 1161.52, 691.83, 475.21, 256.47}},
              {700, 0, {1455.19, 1306.26, 1037.62, 617.40, 423.81, 228.59}},
              {620, -5, {1318.84, 1183.60, 939.60, 558.18, 382.81, 206.32}}};
  for (const auto& row : rows) {
    const Refraction air({row.pressure_hpa, row.temperature_c, 0.0});
    for (int i = 0; i < 6; ++i) {
      const double found_arcsec = air.at_apparent_rad(elevations_deg[i] * deg) / arcsec;
      EXPECT_NEAR(found_arcsec, row.star_arcsec[i], 0.002 * row.star_arcsec[i])
          << row.pressure_hpa << " hPa, " << row.temperature_c << " C, " << elevations_deg[i];
    }
  }
}

// Reference: the Nautical Almanac's 34 arcmin at the horizon are of 10 C and 1010 hPa.
TEST(Refraction, HasTheSizesOfTheHandbooks) {
  EXPECT_NEAR(sea_level.at_apparent_rad(45 * deg) / arcsec, 57.5, 1.0);
  EXPECT_NEAR(sea_level.at_apparent_rad(10 * deg) / arcmin, 5.3, 0.1);
  const Refraction almanac({1010.0, 10.0});
  EXPECT_NEAR(almanac.at_apparent_rad(0) / arcmin, 34.0, 0.7);
}

// Reference: ERFA eraRefco's own two terms.
TEST(Refraction, IsErfasDownTo75DegreesFromTheZenith) {
  double a, b;
  eraRefco(800.0, 5.0, 0.3, 0.7, &a, &b);
  const Refraction refraction(Weather{800.0, 5.0, 0.3}, 0.7);
  for (double z = 0; z <= 75; z += 2.5) {
    const double t = std::tan(z * deg);
    EXPECT_NEAR(refraction.at_apparent_rad((90 - z) * deg), a * t + b * t * t * t, 1e-3 * mas);
  }
}

TEST(Refraction, IsFiniteAndMonotoneFromNadirToZenithAndInvertsItself) {
  for (const double distance_m : {Refraction::star, 100e3, 500e3, 3e6, 4e7}) {
    double before = -10.0;
    for (int i = -9000; i <= 9000; ++i) {
      const double elevation = i * 0.01 * deg;
      const double apparent = sea_level.apparent_from_true_rad(elevation, distance_m);
      ASSERT_TRUE(std::isfinite(apparent)) << i;
      ASSERT_GT(apparent, before) << i;
      ASSERT_LT(apparent - elevation, 35 * arcmin);
      ASSERT_NEAR(sea_level.true_from_apparent_rad(apparent, distance_m), elevation, 1e-3 * mas)
          << i;
      before = apparent;
    }
  }
}

TEST(Refraction, IsTheSameOfAnAngleAndOfItsSineAndCosine) {
  const Refraction dense(Weather{.pressure_hpa = 10000.0, .temperature_c = -20.0});
  for (const Refraction& air : {sea_level, dense, Refraction()})
    for (const double distance_m : {Refraction::star, 500e3})
      for (int i = -9000; i <= 9000; ++i) {
        const double elevation = i * 0.01 * deg;
        const double apparent = air.apparent_from_true_rad(elevation, distance_m);
        const auto seen =
            air.apparent_from_true({std::sin(elevation), std::cos(elevation)}, distance_m);
        ASSERT_NEAR(seen.sine, std::sin(apparent), 1e-14) << i;
        ASSERT_NEAR(seen.cosine, std::cos(apparent), 1e-14) << i;
      }
}

TEST(Refraction, IsConstantUnderTheHorizon) {
  const double horizon = sea_level.at_apparent_rad(0.0);
  EXPECT_EQ(sea_level.at_apparent_rad(-5 * deg), horizon);
  EXPECT_NEAR(sea_level.apparent_from_true_rad(-5 * deg), -5 * deg + horizon, 1e-15);
  EXPECT_NEAR(sea_level.apparent_from_true_rad(-horizon), 0.0, 1e-13);
}

TEST(Refraction, NoAirBendsNothing) {
  for (const Refraction& none : {Refraction(), Refraction(Weather{.pressure_hpa = 0.0})})
    for (double e = -1.5; e < 1.5; e += 0.1) {
      EXPECT_EQ(none.apparent_from_true_rad(e), e);
      EXPECT_EQ(none.apparent_from_true_rad(e, 1e6), e);
      EXPECT_EQ(none.true_from_apparent_rad(e), e);
    }
}

TEST(AtmosphericRefraction, ALowerMoonGivesNoLessLightThanTheBoundSays) {
  for (const double k_v : {0.1, 0.25, 0.4})
    for (double true_rad = -5.0 * deg; true_rad < 80.0 * deg; true_rad += 0.05 * deg) {
      const double lifted_rad = sea_level.apparent_from_true_rad(true_rad);
      const auto moonlight = [&](double moon_rad) {
        return scattered_moonlight_s10(60.0 * deg, 0.8, std::sin(moon_rad), -12.0, {k_v});
      };
      PlanFacts f;
      f.moon_refraction_rad = lifted_rad - true_rad;
      f.moon_is_down = true_rad < 0.0;
      SkySample sample{.sky_e = 100.0, .noise_e = 10.0};
      sample.part_e[static_cast<std::size_t>(SkyPart::scattered_moonlight)] = 100.0;
      f.sky.push_back(sample);
      const double lacks = 1.0 - moonlight(true_rad) / moonlight(lifted_rad);
      EXPECT_GE(AtmosphericRefraction::error(0, f).background_sigma, 10.0 * lacks - 1e-12)
          << true_rad / deg << " deg, k " << k_v;
    }
}

TEST(Refraction, NonsenseIsRefused) {
  EXPECT_THROW(Refraction(Weather{.pressure_hpa = -1}), Error);
  EXPECT_THROW(Refraction(Weather{.humidity = 2}), Error);
  EXPECT_THROW(Refraction(Weather{.temperature_c = std::nan("")}), Error);
  EXPECT_THROW(Refraction(Weather{}, 0.0), Error);
}

}  // namespace
}  // namespace dmise
