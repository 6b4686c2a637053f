#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "core/base/error.h"
#include "core/detector/exposure/expose.h"
#include "tests/support/detector_of.h"

namespace dmise {
namespace {

constexpr int columns = 233, rows = 171;
const Exposure exposure{.seed = 5, .sensor = "s", .frame = 4, .exposure_s = 10, .idle_s = 2};

/// Every effect, each as strong as in a real detector or stronger. Sixteenths of an electron are
/// counted, so that what is not a whole electron shows too.
constexpr Detector busy = detector_of({.dark_e_per_s = 2,
                                       .read_noise_e = 5,
                                       .full_well_e = 3000,
                                       .gain_e_per_dn = 1.0 / 16,
                                       .bias_dn = 2000,
                                       .prnu_rms = 0.02,
                                       .hot_pixel_fraction = 0.01,
                                       .hot_pixel_e_per_s = 20,
                                       .column_noise_e = 4,
                                       .nonlinearity = 0.02,
                                       .interpixel_coupling = 0.01,
                                       .blooming = true,
                                       .persistence_fraction = 0.05,
                                       .persistence_s = 20,
                                       .cosmic_rays_per_px_s = 1e-4,
                                       .cosmic_ray_e_per_px = 500,
                                       .reference_px = 4});

ExpectedElectronImage some_light() {
  ExpectedElectronImage light(columns, rows, 150.0f);
  for (int x = 0; x < columns; ++x) light.at(x, x % rows) = 900.0f;
  light.at(90, 80) = 40000.0f;  // blooms
  return light;
}

/// The second of two exposures, so that there is persistence.
struct Result {
  CountImage counts;
  FlagImage flags;
  EffectTimes times;
};

Result read_out(const Detector& d, const EffectSet& effects = {}, Threads* threads = nullptr,
                SimdLevel level = best_simd_level()) {
  Threads one(1);
  Result result;
  DetectorMemory memory;
  Exposure before = exposure;
  --before.frame;
  expose(some_light(), d, before, effects, threads ? *threads : one, result.counts, nullptr,
         {.memory = &memory, .level = level});
  expose(some_light(), d, exposure, effects, threads ? *threads : one, result.counts, &result.times,
         {.memory = &memory, .flags = &result.flags, .level = level});
  return result;
}

struct Named {
  EffectFacts effect;
  std::function<void(Detector&)> weak;  // there, but too weak to change a count
};

const std::vector<Named> all_effects = {
    {PixelResponse::facts, [](Detector& d) { d.prnu_rms = 1e-12; }},
    {DarkCurrent::facts, [](Detector& d) { d.dark_e_per_s = 1e-15; }},
    {HotPixels::facts, [](Detector& d) { d.hot_pixel_e_per_s = 1e-15; }},
    {CosmicRays::facts, [](Detector& d) { d.cosmic_ray_e_per_px = 1e-9; }},
    {Persistence::facts, [](Detector& d) { d.persistence_fraction = 1e-15; }},
    {InterpixelCoupling::facts, [](Detector& d) { d.interpixel_coupling = 1e-12; }},
    {Nonlinearity::facts, [](Detector& d) { d.nonlinearity = 1e-12; }},
    {ColumnNoise::facts, [](Detector& d) { d.column_noise_e = 1e-9; }},
    {ReadNoise::facts, [](Detector& d) { d.read_noise_e = 1e-9; }},
};

// An effect that is there but too weak to matter draws its numbers as ever; the frame is the one
// without it, byte for byte: so the others' numbers are the same.
TEST(Chain, AddingAnEffectLeavesTheOthersNoiseUnchanged) {
  for (const auto& [effect, weaken] : all_effects) {
    Detector weak = busy;
    weaken(weak);
    EffectSet without;
    without.set(effect, false);
    ASSERT_TRUE(applies(weak, effect));
    EXPECT_EQ(read_out(weak).counts.pixels, read_out(weak, without).counts.pixels) << effect.name;
    EXPECT_NE(read_out(busy).counts.pixels, read_out(weak).counts.pixels) << effect.name;
  }
}

// What only clips or empties: where it does not act, nothing changes.
TEST(Chain, AddingALimitLeavesThePixelsBelowItUnchanged) {
  Detector apart = busy;
  apart.interpixel_coupling = 0;
  for (const EffectFacts& effect : {FullWell::facts, Blooming::facts, ReferencePixels::facts}) {
    EffectSet without;
    without.set(effect, false);
    const Result with = read_out(apart), free = read_out(apart, without);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < with.counts.pixels.size(); ++i) {
      const int acted = flag_full_well | flag_bloomed | flag_reference;
      if (with.flags.pixels[i] & acted)
        ++changed;
      else
        ASSERT_EQ(with.counts.pixels[i], free.counts.pixels[i]) << effect.name << i;
    }
    EXPECT_GT(changed, 0u);
  }
}

// Noise of two effects from different streams: no correlation, however it is paired.
TEST(Chain, EveryEffectHasAStreamOfItsOwn) {
  const auto noise = [](const EffectFacts& effect) {
    Detector d = detector_of(
        {.dark_e_per_s = 15, .read_noise_e = 12, .gain_e_per_dn = 1.0 / 16, .bias_dn = 2000});
    EffectSet only;
    for (const EffectFacts& e : {PhotonNoise::facts, DarkCurrent::facts, ReadNoise::facts})
      only.set(e, e.name == effect.name);
    Threads one(1);
    CountImage counts;
    expose(ExpectedElectronImage(1000, 100, 150.0f), d, exposure, only, one, counts);
    double mean = 0;
    for (auto c : counts.pixels) mean += c;
    mean /= double(counts.pixels.size());
    std::vector<double> values;
    for (auto c : counts.pixels) values.push_back(c - mean);
    return values;
  };
  const std::vector<std::vector<double>> draws = {
      noise(PhotonNoise::facts), noise(DarkCurrent::facts), noise(ReadNoise::facts)};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < a; ++b) {
      double ab = 0, aa = 0, bb = 0;
      for (std::size_t i = 0; i < draws[a].size(); ++i)
        ab += draws[a][i] * draws[b][i], aa += draws[a][i] * draws[a][i],
            bb += draws[b][i] * draws[b][i];
      EXPECT_LT(std::abs(ab / std::sqrt(aa * bb)), 4 / std::sqrt(1e5)) << a << b;
    }
}

TEST(Chain, WhatIsOffOrZeroCostsNothing) {
  const Result plain = read_out(detector_of({.full_well_e = 3000, .gain_e_per_dn = 0.1}));
  for (const auto& [effect, weaken] : all_effects) {
    EXPECT_EQ(plain.times[effect], 0.0) << effect.name;
    EXPECT_GT(read_out(busy).times[effect], 0.0) << effect.name;
    EffectSet without;
    without.set(effect, false);
    EXPECT_EQ(read_out(busy, without).times[effect], 0.0) << effect.name;
  }
}

TEST(Chain, TheBytesOfAllEffectsDependOnNeitherThreadsNorInstructionSet) {
  const Result reference = read_out(busy);
  for (int n : {1, 2, 4})
    for (SimdLevel level : {SimdLevel::sse2, SimdLevel::avx2, SimdLevel::avx512}) {
      if (level > best_simd_level()) continue;
      Threads threads(n);
      const Result other = read_out(busy, {}, &threads, level);
      ASSERT_EQ(other.counts.pixels, reference.counts.pixels) << n << name(level);
      ASSERT_EQ(other.flags.pixels, reference.flags.pixels) << n << name(level);
    }
}

TEST(Flags, SayWhatBefellEachPixel) {
  Detector d = detector_of(
      {.full_well_e = 3000, .gain_e_per_dn = 0.05, .blooming = true, .reference_px = 2});
  ExpectedElectronImage light(20, 40, 100.0f);
  light.at(10, 20) = 3000.0f * 5;   // fills itself and about two pixels above and below
  light.at(4, 4) = 3200.0f * 0.9f;  // 57,600 DN of 65,535
  Threads one(1);
  CountImage counts;
  FlagImage flags;
  const SaturatedPixels saturated =
      expose(light, d, exposure, {}, one, counts, nullptr, {.flags = &flags});
  EXPECT_EQ(flags.at(10, 20) & (flag_full_well | flag_bloomed), flag_full_well);
  EXPECT_EQ(flags.at(10, 21) & (flag_full_well | flag_bloomed), flag_full_well | flag_bloomed);
  EXPECT_EQ(flags.at(11, 20), 0);
  EXPECT_EQ(flags.at(4, 4), 0);
  EXPECT_EQ(flags.at(1, 20), flag_reference | flag_adc_low);  // empty, without noise or bias
  EXPECT_EQ(flags.at(18, 20), flag_reference | flag_adc_low);
  EXPECT_EQ(flags.at(2, 2) & flag_reference, 0);
  std::size_t full = 0;
  for (auto f : flags.pixels) full += (f & flag_full_well) != 0;
  EXPECT_EQ(full, saturated.full_well);
  d.blooming = false;
  d.gain_e_per_dn = 0.04;  // now the ADC ends at 2621 e-
  const SaturatedPixels clipped =
      expose(light, d, exposure, {}, one, counts, nullptr, {.flags = &flags});
  EXPECT_EQ(flags.at(10, 20), flag_full_well | flag_adc_high);
  EXPECT_EQ(flags.at(4, 4), flag_adc_high);
  EXPECT_EQ(clipped, (SaturatedPixels{.full_well = 1, .adc = 2}));
}

TEST(Flags, NameHotPixelsAndCosmicRays) {
  Detector d = busy;
  d.blooming = false;
  const Result result = read_out(d);
  std::size_t hot = 0, hit = 0;
  for (auto f : result.flags.pixels) hot += (f & flag_hot) != 0, hit += (f & flag_cosmic_ray) != 0;
  const double pixels = columns * rows;
  EXPECT_NEAR(double(hot), 0.01 * pixels, 4 * std::sqrt(0.01 * pixels));
  EXPECT_GT(double(hit), 1e-4 * 10 * pixels - 4 * std::sqrt(1e-3 * pixels));
}

TEST(CosmicRays, MoreThanCanBeSimulatedAreRefused) {
  Detector d = busy;
  d.cosmic_rays_per_px_s = 1e-3;
  Threads one(1);
  CountImage counts;
  EXPECT_THROW(expose(ExpectedElectronImage(2000, 2000), d, {1, "s", 1, 3600.0}, {}, one, counts),
               Error);
}

}  // namespace
}  // namespace dmise
