#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/sky/air/air_extinction.h"
#include "core/sky/air/scintillation.h"

namespace dmise {
namespace {

struct Row {
  double aperture_m, exposure_s, airmass, rate_rad_per_s, ratio;
};
constexpr Row rows[] = {
#include "tests/sky/moving_scintillation_reference.inc"
};

// Reference: the whole integral over heights and spatial frequencies, with the aperture and the
// exposure (tests/reference/moving_scintillation.py).
TEST(MovingScintillation, AveragesAsTheIntegralOverTheTurbulenceDoes) {
  const MotionAveraging averaging(BlownTurbulence{});
  for (const Row& row : rows)
    EXPECT_NEAR(averaging(row.rate_rad_per_s, row.airmass) / row.ratio, 1.0, 0.05)
        << row.aperture_m << " " << row.airmass << " " << row.rate_rad_per_s;
}

/// Deviation of the light of many sources that move at a rate, seen at 30 deg elevation.
double deviation(double exposure_s, double rate_rad_per_s, bool heeds_motion) {
  const Band band = *filter_named("bessell-V");
  const Curve extinction;
  const std::optional<Clouds> clouds;
  AirExposure exposure{.band = band,
                       .extinction_mag_per_airmass = extinction,
                       .clouds = clouds,
                       .aperture_m = 0.3,
                       .exposure_s = exposure_s,
                       .site_height_m = 0.0,
                       .time_s = 0.0,
                       .up = {0, 0, 1},
                       .seed = 7,
                       .sensor = "a",
                       .frame = 1};
  if (heeds_motion) exposure.turbulence = BlownTurbulence{};
  const Scintillation scintillation(exposure);
  double squares = 0.0;
  constexpr std::uint32_t sources = 20000;
  for (std::uint32_t i = 0; i < sources; ++i) {
    const double factor = scintillation.apply({{std::cos(30 * deg), 0, std::sin(30 * deg)},
                                               0.65,
                                               SightLine::Source::object,
                                               i,
                                               rate_rad_per_s});
    squares += (factor - 1) * (factor - 1);
  }
  return std::sqrt(squares / sources);
}

// By its variance: 0.1547 of what stands still for 5 mrad/s at an airmass of 2.
TEST(MovingScintillation, ASourceThatMovesScintillatesLess) {
  const double still = deviation(1.0, 0.0, true);
  EXPECT_EQ(still, deviation(1.0, 0.0, false));
  EXPECT_EQ(deviation(1.0, 5e-3, false), still);
  EXPECT_NEAR(deviation(1.0, 5e-3, true) / still, std::sqrt(0.1547), 0.02);
  EXPECT_NEAR(deviation(1.0, 7.3e-5, true) / still, 1.0, 0.03);
}

// An exposure that averages nothing averages no more for a source that moves.
TEST(MovingScintillation, AShortExposureIsAsItWas) {
  EXPECT_EQ(deviation(1e-4, 5e-3, true), deviation(1e-4, 0.0, true));
}

TEST(MovingScintillation, IsFiniteForEveryRateAndProfile) {
  const BlownTurbulence none{.profile = HufnagelValley{.high_wind_m_per_s = 0, .ground_cn2 = 0},
                             .wind = {.ground_m_per_s = 0, .jet_m_per_s = 0}};
  for (const auto& turbulence : {BlownTurbulence{}, none}) {
    const MotionAveraging averaging(turbulence);
    double last = 1.0;
    for (const double rate : {0.0, 1e-9, 1e-5, 1e-3, 0.1, 1.0, 100.0}) {
      const double ratio = averaging(rate, 38.0);
      EXPECT_TRUE(ratio > 0.0 && ratio <= last) << rate;
      last = ratio;
    }
  }
  EXPECT_FALSE(MovingScintillation::applies({.on_ground = false}));
  EXPECT_FALSE(EffectSet().has(MovingScintillation::facts));
}

template <class Effect>
void expect_factors_of_each(const AirExposure& exposure) {
  const Effect effect(exposure);
  std::vector<Vec<Gcrs>> apparent;
  std::vector<double> airmass, bv, rate;
  std::vector<std::uint32_t> number;
  for (std::uint32_t i = 0; i < 1001; ++i) {
    apparent.push_back({0, 0, 1});
    airmass.push_back(1.0 + 0.039 * i);
    bv.push_back(-0.6 + 0.003 * i);
    rate.push_back(1e-5 * i);
    number.push_back(i * 7919 * 104729);
  }
  const SightLines lines{apparent, airmass, bv, rate, number};
  std::vector<double> factors(lines.size(), 2.0);
  effect.apply(lines, factors);
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const double one = 2.0 * effect.apply(lines[i]);
    EXPECT_NEAR(factors[i], one, 1e-14 * one) << i;
  }
}

TEST(AirEffects, OfManyStarsAreThoseOfEach) {
  const Band band = *filter_named("bessell-V");
  const Curve extinction = *extinction_of_site("lick");
  const std::optional<Clouds> clouds;
  AirExposure exposure{.band = band,
                       .extinction_mag_per_airmass = extinction,
                       .clouds = clouds,
                       .aperture_m = 0.01,
                       .exposure_s = 0.1,
                       .site_height_m = 0.0,
                       .time_s = 0.0,
                       .up = {0, 0, 1},
                       .seed = 7,
                       .sensor = "a",
                       .frame = 1};
  expect_factors_of_each<AirExtinction>(exposure);
  expect_factors_of_each<Scintillation>(exposure);
  exposure.turbulence = BlownTurbulence{};
  expect_factors_of_each<Scintillation>(exposure);
}

}  // namespace
}  // namespace dmise
