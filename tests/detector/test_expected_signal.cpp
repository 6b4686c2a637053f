#include "core/detector/exposure/expected_signal.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dmise {
namespace {

// The mean of many frames, in its own standard error.
TEST(ExpectedSignal, IsTheMeanOfFrames) {
  Threads threads(1);
  Detector d;
  d.dark_e_per_s = 30.0;
  d.prnu_rms = 0.05;
  d.interpixel_coupling = 0.02;
  d.nonlinearity = 0.05;
  d.full_well_e = 5000.0;
  d.read_noise_e = 3.0;
  d.gain_e_per_dn = 1.0;
  d.bias_dn = 100.0;
  d.adc_bits = 16;
  ExpectedElectronImage light(32, 32, 500.0f);
  light.at(16, 16) = 3000.0f;
  Exposure exposure{.seed = 3, .sensor = "eye", .frame = 1, .exposure_s = 1.0, .idle_s = 0.0};
  const auto expected = expected_signal(light, d, exposure, {}, threads);
  constexpr int frames = 400;
  std::vector<double> sum(light.pixels.size());
  CountImage counts;
  for (int k = 0; k < frames; ++k) {
    exposure.frame = std::uint32_t(k + 1);
    expose(light, d, exposure, {}, threads, counts);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += counts.pixels[i] - 100.0;
  }
  double chi2 = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    // Coupling c leaves (1 - 4 c)^2 + 4 c^2 of the shot noise's variance, the amplifier its
    // slope^2.
    constexpr double coupled = 0.92 * 0.92 + 4.0 * 0.02 * 0.02;
    const double drawn_e = light.pixels[i] + 30.0;
    const double slope = 1.0 - 2.0 * 0.05 * drawn_e / 5000.0;
    const double variance = (drawn_e * coupled * slope * slope + 9.0 + 1.0 / 12.0) / frames;
    chi2 += std::pow(sum[i] / frames - expected.pixels[i], 2.0) / variance;
  }
  EXPECT_NEAR(chi2 / double(sum.size()), 1.0, 0.15);
}

// Reference: tests/reference/galsim_detector.py.
TEST(ExpectedSignal, CouplesWhatTheAmplifierHasBentLikeGalSim) {
  Threads threads(1);
  Detector d;
  d.full_well_e = 30000.0;
  d.nonlinearity = 0.05;
  d.interpixel_coupling = 0.02;
  ExpectedElectronImage light(5, 5);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x)
      light.at(x, y) = float(100 * x * x + 900 * y + (x == 2 && y == 2 ? 20000 : 0));
  const Exposure exposure{.seed = 1, .sensor = "eye", .frame = 1, .exposure_s = 1.0, .idle_s = 0.0};
  const ElectronImage signal = expected_signal(light, d, exposure, {}, threads);
  const double galsim[3][3] = {{1002.262667, 1684.834000, 1798.497333},
                               {2281.634000, 19847.572000, 3075.468667},
                               {2790.838667, 3471.610000, 3582.273333}};
  for (int y = 1; y < 4; ++y)
    for (int x = 1; x < 4; ++x)
      EXPECT_NEAR(signal.at(x, y), galsim[y - 1][x - 1], 2e-3) << x << ", " << y;
}

TEST(ExpectedSignal, HasWhatIsOnAlone) {
  Threads threads(1);
  Detector d;
  d.dark_e_per_s = 50.0;
  d.full_well_e = 1e5;
  const ExpectedElectronImage light(8, 8, 1000.0f);
  const Exposure exposure{.seed = 1, .sensor = "eye", .frame = 1, .exposure_s = 2.0, .idle_s = 0.0};
  EXPECT_FLOAT_EQ(expected_signal(light, d, exposure, {}, threads).at(3, 3), 1100.0f);
  EffectSet effects;
  effects.set(DarkCurrent::facts, false);
  EXPECT_FLOAT_EQ(expected_signal(light, d, exposure, effects, threads).at(3, 3), 1000.0f);
}

}  // namespace
}  // namespace dmise
