#include "core/detector/detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "core/base/error.h"
#include "tests/support/detector_of.h"

namespace dmise {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string complaint(const Detector& d) {
  try {
    check(d);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

std::string complaint(const DetectorNumbers& numbers) { return complaint(detector_of(numbers)); }

TEST(DetectorFigures, NonsenseIsRefusedByName) {
  EXPECT_EQ(complaint({.full_well_e = 0}), "detector.full_well_e: must be > 0 and <= 1e+09, got 0");
  EXPECT_EQ(complaint({.gain_e_per_dn = 0}),
            "detector.gain_e_per_dn: must be > 0 and <= 1e+06, got 0");
  EXPECT_EQ(complaint({.adc_bits = 32}),
            "detector.adc_bits: must be 1..16: counts are 16-bit numbers in frames and messages, "
            "got 32");
  EXPECT_EQ(complaint({.adc_bits = 0}).find("detector.adc_bits: must be 1..16"), 0u);
  EXPECT_EQ(complaint({.bias_dn = 2, .adc_bits = 1}),
            "detector.bias_dn: must be below 2^adc_bits, got 2");
  EXPECT_EQ(complaint({.persistence_fraction = 0.1}),
            "detector.persistence_s: must be >= 0.001 with persistence, got 0");
  EXPECT_EQ(complaint({.temperature_c = -10}),
            "detector.dark_doubling_k: must be > 0 when temperature_c is not dark_reference_c, "
            "got 0");
  EXPECT_EQ(complaint({.dark_e_per_s = 1e6, .temperature_c = 90, .dark_doubling_k = 5}),
            "detector.temperature_c: dark current there must be <= 1e9 e-/s, got 90");
  EXPECT_EQ(complaint(DetectorNumbers{}), "");
}

TEST(DetectorFigures, EveryOneRefusesNanAndWhatIsOutOfItsRange) {
  for (const DetectorParameter& p : detector_parameters()) {
    if (std::holds_alternative<bool Detector::*>(p.value)) continue;
    const bool real = std::holds_alternative<double Detector::*>(p.value);
    for (const double bad : {real ? nan : p.most + 1, p.least - 1, p.most * 1.01 + 1}) {
      Detector d;
      p.set(d, bad);
      EXPECT_EQ(complaint(d).find("detector." + std::string(p.key) + ": must be "), 0u)
          << p.key << " " << bad;
    }
  }
}

// A figure has one name in YAML, FITS and code; FITS allows eight characters.
TEST(DetectorFigures, HaveKeywordsOfTheirOwn) {
  std::set<std::string> seen;
  for (const DetectorParameter& p : detector_parameters()) {
    EXPECT_LE(p.keyword.size(), 8u);
    if (!p.keyword.empty()) {
      EXPECT_TRUE(seen.insert(std::string(p.keyword)).second) << p.keyword;
    }
  }
}

TEST(DarkCurrent, FollowsTheDetectorsTemperature) {
  const Detector d = detector_of({.dark_e_per_s = 8,
                                  .dark_reference_c = 20,
                                  .temperature_c = 2,
                                  .dark_doubling_k = 6,
                                  .hot_pixel_e_per_s = 80});
  EXPECT_NEAR(d.thermal_factor(), 1.0 / 8, 1e-12);
  const Detector acting = acting_detector(d, {});
  EXPECT_NEAR(acting.dark_e_per_s, 1.0, 1e-12);
  EXPECT_NEAR(acting.hot_pixel_e_per_s, 10.0, 1e-12);
  EXPECT_NEAR(acting.thermal_factor(), 1.0, 1e-12);  // not cooled twice
}

TEST(DetectorFigures, OfEffectsThatAreOffAreZero) {
  const Detector d = detector_of({.dark_e_per_s = 1,
                                  .read_noise_e = 1,
                                  .gain_e_per_dn = 0.5,
                                  .bias_dn = 100,
                                  .adc_bits = 12,
                                  .prnu_rms = 0.1,
                                  .hot_pixel_fraction = 0.1,
                                  .hot_pixel_e_per_s = 1,
                                  .column_noise_e = 1,
                                  .nonlinearity = 0.1,
                                  .interpixel_coupling = 0.1,
                                  .blooming = true,
                                  .persistence_fraction = 0.1,
                                  .persistence_s = 1,
                                  .cosmic_rays_per_px_s = 1e-6,
                                  .reference_px = 4});
  EffectSet none;
  DetectorEffects::for_each([&]<class Effect>() { none.set(Effect::facts, false); });
  const Detector off = acting_detector(d, none);
  for (const EffectFacts& e :
       {PixelResponse::facts, DarkCurrent::facts, HotPixels::facts, CosmicRays::facts,
        ReferencePixels::facts, Persistence::facts, Blooming::facts, InterpixelCoupling::facts,
        Nonlinearity::facts, ColumnNoise::facts, ReadNoise::facts}) {
    EXPECT_TRUE(applies(d, e)) << e.name;
    EXPECT_FALSE(applies(off, e)) << e.name;
  }
  EXPECT_EQ(off.gain_e_per_dn, 1.0);
  EXPECT_EQ(off.bias_dn, 0.0);
  EXPECT_EQ(off.adc_bits, 16);
  EXPECT_EQ(acting_detector(d, {}), d);
}

}  // namespace
}  // namespace dmise
