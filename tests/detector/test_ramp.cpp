#include "core/detector/ramp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/detector/exposure/expected_noise.h"
#include "core/detector/exposure/expose.h"
#include "tests/support/detector_of.h"

namespace dmise {
namespace {

constexpr int columns = 800, rows = 500;
constexpr double pixels = double(columns) * rows;

Detector ramp(int reads, int fowler, double noise_e, double reset_e = 30.0) {
  Detector d = detector_of({.read_noise_e = noise_e, .gain_e_per_dn = 0.1, .bias_dn = 5000});
  d.ramp_reads = reads;
  d.fowler_reads = fowler;
  d.reset_noise_e = reset_e;
  return d;
}

const Exposure exposure{.seed = 4, .sensor = "s", .frame = 1, .exposure_s = 100.0};

struct Moments {
  double mean = 0.0, variance = 0.0;
};

Moments moments_of(const CountImage& counts) {
  double sum = 0.0, squares = 0.0;
  for (const auto c : counts.pixels) sum += 0.1 * (c - 5000.0);
  const double mean = sum / pixels;
  for (const auto c : counts.pixels) squares += std::pow(0.1 * (c - 5000.0) - mean, 2);
  return {mean, squares / pixels};
}

Moments exposed(const Detector& d, double light_e) {
  CountImage counts;
  Threads threads(2);
  expose(ExpectedElectronImage(columns, rows, float(light_e)), d, exposure, {}, threads, counts);
  return moments_of(counts);
}

struct Case {
  int reads, fowler;
  double light_e, noise_e, variance_e2;
};

// Reference: ramps that numpy reads and fits one by one, 4e5 of each: tests/reference/ramp_fits.py.
constexpr Case cases[] = {{2, 0, 50, 10, 249.53},     {8, 0, 0, 10, 116.87},
                          {8, 0, 400, 10, 551.33},    {32, 0, 5, 10, 41.11},
                          {32, 0, 3000, 10, 3543.00}, {32, 16, 0, 10, 47.04},
                          {64, 8, 200, 10, 247.02}};

TEST(Ramp, VariancesAreThoseOfRampsReadOneByOne) {
  for (const Case& c : cases) {
    SCOPED_TRACE(c.reads * 1000 + c.fowler);
    const Detector d = ramp(c.reads, c.fowler, c.noise_e);
    const Moments m = exposed(d, c.light_e);
    EXPECT_NEAR(m.mean, c.light_e, 4 * std::sqrt(c.variance_e2 / pixels) + 0.06);
    // Both variances are of 4e5 values.
    EXPECT_NEAR(m.variance, c.variance_e2, 5 * c.variance_e2 * std::sqrt(4.0 / pixels));
    Threads one(1);
    const auto noise =
        expected_noise(ExpectedElectronImage(2, 2, float(c.light_e)), d, exposure, {}, one);
    EXPECT_NEAR(noise.at(0, 0), std::sqrt(c.variance_e2), 0.01 * std::sqrt(c.variance_e2));
  }
}

// Rauscher et al. 2007, equation 1 with m = 1, and Garnett & Forrest 1993.
TEST(Ramp, ReadAndShotNoiseAreTheClosedForms) {
  for (const int n : {2, 3, 8, 50, 400}) {
    const Detector d = ramp(n, 0, 10.0);
    EXPECT_NEAR(d.fitted_noise_e(10.0), 10.0 * std::sqrt(12.0 * (n - 1) / (n * (n + 1.0))), 1e-9);
    EXPECT_NEAR(d.shot_noise2(), 6.0 * (n * n + 1.0) / (5.0 * n * (n + 1.0)), 1e-9) << n;
  }
  for (const int n : {1, 4, 16})
    EXPECT_NEAR(ramp(2 * n, n, 10.0).fitted_noise_e(10.0),
                10.0 * std::sqrt(2.0 / n) * (2 * n - 1.0) / n, 1e-9);
}

TEST(Ramp, OfOneReadHasTheNoiseOfTheReset) {
  const Moments m = exposed(ramp(1, 0, 10.0, 30.0), 0.0);
  EXPECT_NEAR(m.mean, 0.0, 4 * 32 / std::sqrt(pixels));
  EXPECT_NEAR(m.variance, 1000.0, 4 * 1000 * std::sqrt(2 / pixels) + 1);
  EXPECT_NEAR(acting_detector(ramp(1, 0, 10.0, 30.0), {}).read_noise_e, std::sqrt(1000.0), 1e-9);
}

TEST(Ramp, OfNoReadsIsNone) {
  Detector none = detector_of({.read_noise_e = 10});
  EXPECT_FALSE(applies(none, Ramp::facts));
  none.reset_noise_e = 50.0;
  EXPECT_EQ(acting_detector(none, {}).read_noise_e, 10.0);
  Detector bad = ramp(7, 4, 10.0);
  EXPECT_EQ(fault_of(bad)->key, "fowler_reads");
}

// A line takes a jump in the middle for half as much again, and hardly notices one at an end:
// uniform times have the weights' mean 1 and their variance, 6 (n^2 + 1) / (5 n (n + 1)) - 1.
TEST(Ramp, ACosmicRayIsAJumpAtItsOwnTime) {
  Detector d = ramp(100, 0, 0.0, 0.0);
  d.bias_dn = 1000;
  d.gain_e_per_dn = 1.0;
  d.cosmic_rays_per_px_s = 1e-5;
  d.cosmic_ray_e_per_px = 1000.0;
  Detector at_once = d;
  at_once.ramp_reads = 0;
  Threads one(1);
  CountImage fitted, whole;
  const ExpectedElectronImage dark(columns, rows);
  expose(dark, d, exposure, {}, one, fitted);
  expose(dark, at_once, exposure, {}, one, whole);
  double n = 0, sum = 0, squares = 0, most = 0;
  for (std::size_t i = 0; i < fitted.pixels.size(); ++i) {
    const double charge = whole.pixels[i] - 1000.0;
    if (charge < 500) {
      if (charge == 0) {
        ASSERT_EQ(fitted.pixels[i], 1000);
      }
      continue;
    }
    const double weight = (fitted.pixels[i] - 1000.0) / charge;
    ++n;
    sum += weight;
    squares += weight * weight;
    most = std::max(most, weight);
  }
  ASSERT_GT(n, 300);
  EXPECT_NEAR(sum / n, 1.0, 4 * std::sqrt(0.19 / n));
  EXPECT_NEAR(squares / n, 1.188, 0.1);
  EXPECT_NEAR(most, 1.5, 0.03);
}

}  // namespace
}  // namespace dmise
