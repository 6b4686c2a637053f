#include "core/detector/readout/em_gain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/detector/exposure/expected_noise.h"
#include "core/detector/exposure/expected_signal.h"
#include "core/detector/exposure/expose.h"
#include "tests/support/detector_of.h"

namespace dmise {
namespace {

constexpr int columns = 1000, rows = 400;

/// What the register gives for that many electrons, by pixel, before it is digitised.
std::vector<float> multiplied(double gain, int stages, float electrons) {
  Detector d = detector_of({.full_well_e = 1e9});
  d.em_gain = gain;
  d.em_stages = stages;
  const ExpectedElectronImage light(columns, rows, electrons);
  const Exposure exposure{.seed = 5, .sensor = "s", .frame = 1, .exposure_s = 1.0};
  PersistenceMemory traps;
  const RngKey key = rng_key(5, "s", 1, EmGain::facts.name);
  const ExposureFacts exposed{.light = light,
                              .detector = d,
                              .exposure = exposure,
                              .traps = traps,
                              .level = best_simd_level(),
                              .key = key,
                              .fixed_key = key};
  std::vector<float> out(light.pixels.begin(), light.pixels.end());
  Piece piece{.first = 0, .electrons = out};
  static_cast<const EmGain&>(d).apply(exposed, piece);
  for (float& e : out) e = float(e * gain);
  return out;
}

struct Moments {
  double mean = 0.0, variance = 0.0;
};

Moments moments_of(const std::vector<float>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double v : values) sum += v;
  const double mean = sum / double(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, squares / double(values.size())};
}

struct Case {
  double gain;
  int stages;
  float electrons;
  double excess2;
  std::pair<int, double> below[5];  // share of outputs up to
};

// Reference: the exact distribution of the register, stage by stage, by its generating function:
// tests/reference/em_register.py. Its excess noise is that of Robbins & Hadwen 2003.
constexpr Case cases[] = {
    {2.0, 100, 3, 1.493092, {{3, 0.12320}, {6, 0.65576}, {9, 0.91120}, {12, 0.98136}, {1, 0.0}}},
    {30.0,
     536,
     1,
     1.954438,
     {{7, 0.20907}, {15, 0.39647}, {30, 0.63737}, {45, 0.78249}, {60, 0.86969}}},
    {300.0,
     536,
     1,
     1.975567,
     {{75, 0.21777}, {150, 0.39036}, {300, 0.63108}, {450, 0.77738}, {600, 0.86591}}},
    {300.0,
     536,
     4,
     1.975567,
     {{300, 0.01782}, {600, 0.13945}, {1200, 0.56586}, {1800, 0.85089}, {2400, 0.95925}}},
    {100.0,
     64,
     20,
     1.852533,
     {{500, 0.0}, {1000, 0.00177}, {2000, 0.52703}, {3000, 0.98538}, {4000, 0.99995}}}};

TEST(EmGain, HasTheDistributionOfARegisterStageByStage) {
  for (const Case& c : cases) {
    SCOPED_TRACE(c.gain * 1000 + c.electrons);
    const auto out = multiplied(c.gain, c.stages, c.electrons);
    const double n = double(out.size());
    const Moments m = moments_of(out);
    const double mean = c.gain * c.electrons;
    const double variance = c.electrons * c.gain * c.gain * (c.excess2 - 1.0);
    EXPECT_NEAR(m.mean, mean, 4.0 * std::sqrt(variance / n));
    // Kurtosis 3 + 6 / electrons of a Gamma distribution.
    EXPECT_NEAR(m.variance, variance, 4.0 * variance * std::sqrt((2.0 + 6.0 / c.electrons) / n));
    for (const auto& [count, share] : c.below) {
      const double found =
          double(std::count_if(out.begin(), out.end(), [&](float v) { return v <= count + 0.5; })) /
          n;
      // 4 sigma, and what a mixture by mean and variance differs by in its shape.
      EXPECT_NEAR(found, share, 4.0 * std::sqrt(share * (1.0 - share) / n) + 0.004) << count;
    }
  }
}

// Basden et al. 2003: at a large gain of very many stages the output of n electrons is a Gamma
// (Erlang) distribution of shape n and scale G.
TEST(EmGain, ManyStagesOfALargeGainAreAGammaDistribution) {
  constexpr double gain = 2000.0;
  for (const float electrons : {1.0f, 2.0f, 5.0f}) {
    auto out = multiplied(gain, 10000, electrons);
    std::sort(out.begin(), out.end());
    double distance = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double x = out[i] / gain;
      double term = std::exp(-x), below = 1.0;  // Erlang
      for (int k = 0; k < int(electrons); ++k) {
        below -= term;
        term *= x / (k + 1);
      }
      distance = std::max(distance, std::abs(below - (double(i) + 0.5) / double(out.size())));
    }
    // Kolmogorov's distance of 1e-3 significance, by scipy.stats.kstwobign; 1 / G of counting.
    EXPECT_LT(distance, 1.9495 / std::sqrt(double(out.size())) + 1.0 / gain) << electrons;
  }
}

// The excess noise factor is the root of 2.
TEST(EmGain, ShotNoiseBehindALargeGainIsRootTwoLarger) {
  Detector d = detector_of({.gain_e_per_dn = 0.01});
  d.em_gain = 1000.0;
  d.em_stages = 10000;
  Threads threads(2);
  CountImage counts;
  const ExpectedElectronImage light(columns, rows, 100.0f);
  const Exposure exposure{.seed = 2, .sensor = "s", .frame = 1, .exposure_s = 1.0};
  expose(light, d, exposure, {}, threads, counts);
  std::vector<float> e(counts.pixels.begin(), counts.pixels.end());
  for (float& v : e) v *= 0.01f;
  const Moments m = moments_of(e);
  EXPECT_NEAR(m.mean, 100.0, 0.1);
  EXPECT_NEAR(std::sqrt(m.variance / 100.0), std::sqrt(2.0), 0.006);
  EXPECT_NEAR(expected_noise(light, d, exposure, {}, threads).at(5, 5), std::sqrt(m.variance),
              0.05);
}

TEST(EmGain, ClockInducedChargeIsAPoissonMeanOfEveryPixel) {
  Detector d = detector_of({.gain_e_per_dn = 0.01});
  d.clock_induced_e = 0.02;
  Threads one(1);
  CountImage counts;
  const ExpectedElectronImage dark(columns, rows);
  const Exposure exposure{.seed = 2, .sensor = "s", .frame = 1, .exposure_s = 1.0};
  expose(dark, d, exposure, {}, one, counts);
  std::vector<float> e(counts.pixels.begin(), counts.pixels.end());
  for (float& v : e) v *= 0.01f;
  const Moments m = moments_of(e);
  EXPECT_NEAR(m.mean, 0.02, 4 * std::sqrt(0.02 / e.size()));
  EXPECT_NEAR(m.variance, 0.02, 5e-4);
  EXPECT_FLOAT_EQ(expected_signal(dark, d, exposure, {}, one).at(1, 1), 0.02f);
}

TEST(EmGain, NoElectronGivesNoneAndNoGainChangesNothing) {
  for (const float v : multiplied(1000.0, 536, 0.0f)) ASSERT_EQ(v, 0.0f);
  EXPECT_FALSE(applies(detector_of({}), EmGain::facts));
  // Shares of electrons, as persistence leaves, keep their mean.
  const Moments m = moments_of(multiplied(50.0, 536, 0.3f));
  EXPECT_NEAR(m.mean, 15.0, 4 * std::sqrt(m.variance / (columns * rows)));
  EXPECT_NEAR(multiplied(10.0, 536, 1e6f)[3], 1e7, 6e4);
}

TEST(EmGain, AGainBeyondItsStagesIsRefused) {
  Detector d = detector_of({});
  d.em_gain = 1e4;
  d.em_stages = 16;
  EXPECT_FALSE(fault_of(d));
  d.em_gain = 0.5;
  EXPECT_EQ(fault_of(d)->key, "em_gain");
  d.em_gain = 100;
  d.em_stages = 4;
  EXPECT_EQ(fault_of(d)->key, "em_stages");
}

TEST(EmGain, HasTheSameBytesForAnyThreads) {
  Detector d = detector_of({.gain_e_per_dn = 0.1});
  d.em_gain = 300.0;
  CountImage one, three;
  const ExpectedElectronImage light(301, 200, 12.5f);
  const Exposure exposure{.seed = 2, .sensor = "s", .frame = 1, .exposure_s = 1.0};
  Threads a(1), b(3);
  expose(light, d, exposure, {}, a, one);
  expose(light, d, exposure, {}, b, three);
  EXPECT_EQ(one.pixels, three.pixels);
}

}  // namespace
}  // namespace dmise
