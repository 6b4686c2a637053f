#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "core/detector/exposure/expose.h"
#include "core/effects/plan_facts.h"
#include "tests/support/detector_of.h"

namespace dmise {
namespace {

// KAF-8300 as in the paper's all-sky camera.
constexpr Detector kaf8300 = detector_of({.quantum_efficiency = 0.5,
                                          .dark_e_per_s = 0.02,
                                          .read_noise_e = 9.3,
                                          .full_well_e = 25500,
                                          .gain_e_per_dn = 0.35,
                                          .bias_dn = 1000,
                                          .adc_bits = 16});
const Exposure exposure{.seed = 1, .sensor = "atlanta", .frame = 3, .exposure_s = 20};

CountImage read_out(const ExpectedElectronImage& light, const Detector& detector,
                    const EffectSet& effects = {}, SaturatedPixels* saturated = nullptr) {
  Threads one(1);
  CountImage counts;
  const SaturatedPixels s = expose(light, detector, exposure, effects, one, counts);
  if (saturated) *saturated = s;
  return counts;
}

struct Moments {
  double mean, variance;
};
Moments moments(const CountImage& image) {
  double sum = 0, sum2 = 0;
  for (auto c : image.pixels) sum += c, sum2 += double(c) * c;
  const double n = double(image.pixels.size()), mean = sum / n;
  return {mean, sum2 / n - mean * mean};
}

// Janesick's photon transfer: variance [DN2] = signal [DN] / K + (read noise / K)^2, with the 1/12
// of rounding.
TEST(Expose, FollowsThePhotonTransferCurveUntilItSaturates) {
  for (float level : {0.0f, 30.0f, 300.0f, 3000.0f, 18000.0f}) {
    const ExpectedElectronImage light(600, 500, level);
    const Moments m = moments(read_out(light, kaf8300));
    const double signal = (level + 0.4) / 0.35, n = 300000.0;
    const double variance = signal / 0.35 + std::pow(9.3 / 0.35, 2) + 1.0 / 12;
    EXPECT_NEAR(m.mean, 1000 + signal, 4 * std::sqrt(variance / n)) << level;
    EXPECT_NEAR(m.variance / variance, 1.0, 4 * std::sqrt(2 / n)) << level;
  }
}

// Janesick's curve again for the draw of photons, dark current and read-out at once, and for the
// same with traps, which catch their share and where charge is held at 0 and read noise is drawn
// later: within what its bound says, at light of no electron to many.
TEST(Expose, AGaussianDrawFollowsThePhotonTransferCurveWithinItsBound) {
  EffectSet gaussian;
  gaussian.set_level(PhotonNoise::facts, PhotonNoise::gaussian);
  for (const double traps : {0.0, 1e-3})
    for (const float level : {0.0f, 0.1f, 0.6f, 2.0f, 10.0f, 300.0f}) {
      Detector d = kaf8300;
      d.persistence_fraction = traps;
      d.persistence_s = 100.0;
      d.read_noise_e = 2.0;
      Threads one(1);
      CountImage counts;
      DetectorMemory memory;
      expose(ExpectedElectronImage(600, 500, level), d,
             {.seed = 1, .sensor = "a", .frame = 1, .exposure_s = 20}, gaussian, one, counts,
             nullptr, {.memory = &memory});
      const Moments m = moments(counts);
      PlanFacts facts;
      facts.sky = {{.sky_e = level, .noise_e = std::sqrt(level + 0.4 + 4.0)}};
      facts.dark_e = 0.4;
      facts.read_noise_e = 2.0;
      facts.read_later = traps > 0.0;
      const ErrorBound bound = PhotonNoise::error(PhotonNoise::gaussian, facts);
      const double variance_e2 = level + 0.4 + 4.0, n = 300000.0, dn = 0.35;
      const double sigma_dn = std::sqrt(variance_e2) / dn;
      EXPECT_NEAR(m.mean, 1000 + (level + 0.4) * (1.0 - traps) / dn,
                  bound.background_sigma * sigma_dn + 4 * sigma_dn / std::sqrt(n))
          << level << " " << traps;
      const double variance = variance_e2 / dn / dn + 1.0 / 12;
      EXPECT_NEAR(std::sqrt(m.variance / variance), 1.0, bound.noise + 4 / std::sqrt(2 * n))
          << level << " " << traps;
    }
}

TEST(Expose, TheAdcClipsBeforeTheWellIsFullAndBothAreCounted) {
  ExpectedElectronImage light(100, 100, 10.0f);
  light.at(5, 6) = 24000;   // 16 bits x 0.35 e-/DN - bias: the ADC is full at 22.6 ke-
  light.at(7, 8) = 100000;  // above the well
  SaturatedPixels saturated;
  const CountImage counts = read_out(light, kaf8300, {}, &saturated);
  EXPECT_EQ(counts.at(5, 6), 65535);
  EXPECT_EQ(counts.at(7, 8), 65535);
  EXPECT_EQ(saturated, (SaturatedPixels{.full_well = 1, .adc = 2}));
}

TEST(Expose, AFullFrameOfSaturatedPixelsIsAllFlagged) {
  SaturatedPixels saturated;
  read_out(ExpectedElectronImage(33, 17, 1e7f), kaf8300, {}, &saturated);
  EXPECT_EQ(saturated, (SaturatedPixels{33 * 17, 33 * 17}));
}

// The Sun in a field that looks at the sky for 20 s.
TEST(Expose, LightBeyondAnyWellSaturates) {
  for (const float light_e : {3e11f, 4e11f, 1e12f, 1.01e12f, 3e38f})
    for (const bool noisy : {true, false}) {
      ExpectedElectronImage light(200, 200, 1.0f);
      light.at(17, 150) = light_e;
      Detector detector = kaf8300;
      detector.prnu_rms = 0.05;
      EffectSet effects;
      effects.set(PhotonNoise::facts, noisy);
      SaturatedPixels saturated;
      EXPECT_EQ(read_out(light, detector, effects, &saturated).at(17, 150), 65535) << light_e;
      EXPECT_EQ(saturated, (SaturatedPixels{.full_well = 1, .adc = 1})) << light_e;
    }
}

TEST(Expose, OneBitIsAnAdcToo) {
  Detector d = kaf8300;
  d.adc_bits = 1;
  d.bias_dn = 0;
  d.read_noise_e = 0;
  const CountImage counts = read_out(ExpectedElectronImage(10, 10, 100.0f), d);
  for (auto c : counts.pixels) EXPECT_EQ(c, 1);
}

TEST(Expose, NoDetectorHasNegativeGainOr32Bits) {
  for (auto spoil : {+[](Detector& d) { d.gain_e_per_dn = 0; },
                     +[](Detector& d) { d.adc_bits = 32; }, +[](Detector& d) { d.full_well_e = 0; },
                     +[](Detector& d) { d.read_noise_e = std::nan(""); }}) {
    Detector d = kaf8300;
    spoil(d);
    EXPECT_THROW(read_out(ExpectedElectronImage(4, 4, 1.0f), d), ConfigError);
  }
}

TEST(Expose, WithoutQuantisationCountsAreWholeElectrons) {
  EffectSet effects;
  for (const EffectFacts& e :
       {PhotonNoise::facts, DarkCurrent::facts, ReadNoise::facts, Quantisation::facts})
    effects.set(e, false);
  for (auto c : read_out(ExpectedElectronImage(40, 30, 123.4f), kaf8300, effects).pixels)
    EXPECT_EQ(c, 123);
}

// Bias, gain and well out of the way, electrons are the counts.
TEST(Expose, AddingAnEffectLeavesTheOthersNoiseUnchanged) {
  Detector d = kaf8300;
  d.gain_e_per_dn = 1;
  d.full_well_e = 1e6;
  d.dark_e_per_s = 0.5;
  d.read_noise_e = 30;
  const ExpectedElectronImage light(200, 100, 700.0f);
  const auto with = [&](std::initializer_list<EffectFacts> list) {
    EffectSet set;
    for (const EffectFacts& e : {PhotonNoise::facts, DarkCurrent::facts, ReadNoise::facts})
      set.set(e, false);
    for (const EffectFacts& e : list) set.set(e, true);
    return read_out(light, d, set).pixels;
  };
  const auto none = with({}), photon = with({PhotonNoise::facts}),
             dark = with({DarkCurrent::facts}), read = with({ReadNoise::facts}),
             all = with({PhotonNoise::facts, DarkCurrent::facts, ReadNoise::facts});
  for (std::size_t i = 0; i < none.size(); ++i) {
    const int sum = (photon[i] - none[i]) + (dark[i] - none[i]) + (read[i] - none[i]);
    ASSERT_EQ(all[i] - none[i], sum) << i;
  }
}

TEST(Expose, TheBytesDependOnNeitherThreadsNorInstructionSet) {
  ExpectedElectronImage light(2503, 333);
  for (std::size_t i = 0; i < light.pixels.size(); ++i) light.pixels[i] = float(i % 1000) * 0.1f;
  CountImage reference, counts;
  Threads one(1);
  const auto saturated =
      expose(light, kaf8300, exposure, {}, one, reference, nullptr, {.level = SimdLevel::sse2});
  for (int n : {1, 2, 4})
    for (SimdLevel level : {SimdLevel::sse2, SimdLevel::avx2, SimdLevel::avx512}) {
      if (level > best_simd_level()) continue;
      Threads threads(n);
      EXPECT_EQ(expose(light, kaf8300, exposure, {}, threads, counts, nullptr, {.level = level}),
                saturated);
      ASSERT_EQ(counts.pixels, reference.pixels) << n << name(level);
    }
}

TEST(Expose, AnotherFrameSensorOrSeedIsOtherNoise) {
  const ExpectedElectronImage light(50, 50, 100.0f);
  const auto base = read_out(light, kaf8300).pixels;
  Threads one(1);
  for (const Exposure& e :
       {Exposure{2, "atlanta", 3, 20}, {1, "boston", 3, 20}, {1, "atlanta", 4, 20}}) {
    CountImage counts;
    expose(light, kaf8300, e, {}, one, counts);
    EXPECT_NE(counts.pixels, base);
  }
}

TEST(Expose, ANegativeOrUndefinedExpectationIsNamedByItsPixel) {
  ExpectedElectronImage light(200, 200, 1.0f);
  for (const float undefined :
       {std::numeric_limits<float>::quiet_NaN(), -1.0f, std::numeric_limits<float>::infinity()})
    for (bool noisy : {true, false}) {
      light.at(17, 150) = undefined;
      EffectSet effects;
      effects.set(PhotonNoise::facts, noisy);
      try {
        read_out(light, kaf8300, effects);
        FAIL();
      } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("(17, 150)"), std::string::npos) << e.what();
      }
    }
}

}  // namespace
}  // namespace dmise
