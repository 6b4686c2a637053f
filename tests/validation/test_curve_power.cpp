#include "bench/validation/curve_power.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/numeric/rng.h"
#include "core/base/units.h"

namespace dmise {
namespace {

/// A light curve of 60 s at 10 Hz: a trend, a wave of an amplitude and a period, and noise.
PassLightCurve wave(double amplitude_mag, double period_s, double noise_mag,
                    double model_mag = 0.0) {
  PassLightCurve curve;
  const RngKey key = rng_key(1, "test", 0, "noise");
  for (std::uint32_t i = 0; i < 600; ++i) {
    const double t = 0.1 * i, of_wave = std::sin(2.0 * pi * t / period_s);
    curve.time_s.push_back(t);
    curve.smooth_mag.push_back(5.0 + 0.02 * t);
    curve.measured_mag.push_back(5.0 + 0.02 * t + amplitude_mag * of_wave +
                                 noise_mag * double(normal_of(rng_word(key, i, 0))));
  }
  curve.glints_mag = [times = curve.time_s, model_mag, period_s](std::uint64_t) {
    std::vector<double> mag;
    for (const double t : times) mag.push_back(model_mag * std::sin(2.0 * pi * t / period_s));
    return mag;
  };
  return curve;
}

const CurveBand& all(const CurvePower& power) { return power.bands.back(); }

// A wave has the variance of half its square, in the octave of its period.
TEST(CurvePower, IsTheVariance) {
  const PassLightCurve curve = wave(0.2, 5.7, 0.0, 0.1);
  const CurvePower power = curve_power({&curve, 1});
  EXPECT_NEAR(all(power).measured_mean / 0.02, 1.0, 0.03);
  EXPECT_NEAR(all(power).model_mean / 0.005, 1.0, 0.03);
  ASSERT_EQ(power.bands.size(), 6u);
  EXPECT_NEAR(power.bands[1].measured_mean / 0.02, 1.0, 0.1);  // 4 to 8 s
  EXPECT_LT(power.bands[0].measured_mean, 0.0002);
  EXPECT_LT(power.bands[3].measured_mean, 0.0002);
}

// White noise alone has no power that is left; 1 % of its variance is what 300 frequencies tell.
TEST(CurvePower, DoesNotCountWhiteNoise) {
  const PassLightCurve curve = wave(0.0, 5.0, 0.1);
  const CurvePower power = curve_power({&curve, 1});
  EXPECT_NEAR(power.white_mag, 0.1, 0.01);
  EXPECT_NEAR(all(power).measured_mean, 0.0, 0.001);
  EXPECT_NEAR(all(power).model_mean, 0.0, 0.0005);
}

// A gap parts a curve: the longer run is judged. What is too short for a band has none.
TEST(CurvePower, IsOfTheLongestRun) {
  PassLightCurve curve = wave(0.2, 5.7, 0.0);
  for (std::size_t i = 200; i < 600; ++i) curve.time_s[i] += 30.0;
  const CurvePower power = curve_power({&curve, 1});
  EXPECT_EQ(power.bands[3].tracks, 1u);  // 16 to 32 s, of a run of 40 s
  EXPECT_EQ(power.bands[4].tracks, 1u);
  EXPECT_NEAR(all(power).measured_mean / 0.02, 1.0, 0.05);
  PassLightCurve cut = curve;
  cut.time_s.resize(150);
  EXPECT_TRUE(curve_power({&cut, 1}).bands.empty());
  EXPECT_TRUE(curve_power({}).bands.empty());
}

}  // namespace
}  // namespace dmise
