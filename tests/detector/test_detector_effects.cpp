#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/detector/blooming.h"
#include "core/detector/cosmic_rays.h"
#include "core/detector/exposure/expose.h"
#include "core/detector/interpixel_coupling.h"
#include "tests/support/detector_of.h"

namespace dmise {
namespace {

// Counts are electrons above a bias that keeps them positive.
constexpr Detector plain =
    detector_of({.read_noise_e = 0, .full_well_e = 60000, .gain_e_per_dn = 1, .bias_dn = 200});

EffectSet without_photon_noise() {
  EffectSet set;
  set.set(PhotonNoise::facts, false);
  return set;
}

CountImage read_out(const ExpectedElectronImage& light, const Detector& d, std::uint32_t frame = 1,
                    const EffectSet& effects = without_photon_noise(),
                    DetectorMemory* memory = nullptr) {
  Threads two(2);
  CountImage counts;
  expose(light, d, {.seed = 1, .sensor = "s", .frame = frame, .exposure_s = 10, .idle_s = 5},
         effects, two, counts, nullptr, {.memory = memory});
  return counts;
}

double mean(const CountImage& image) {
  return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0) /
             double(image.pixels.size()) -
         200;
}

TEST(Prnu, HasItsRmsAndIsTheSameInEveryFrame) {
  Detector d = plain;
  d.prnu_rms = 0.01;
  const ExpectedElectronImage light(400, 300, 10000.0f);
  const CountImage one = read_out(light, d, 1), two = read_out(light, d, 2);
  EXPECT_EQ(one.pixels, two.pixels);
  double sum2 = 0;
  for (auto c : one.pixels) sum2 += std::pow(c - 200 - 10000.0, 2);
  const double n = double(one.pixels.size());
  EXPECT_NEAR(std::sqrt(sum2 / n), 100.0, 100 * 4 / std::sqrt(2 * n));
  EXPECT_NEAR(mean(one), 10000, 4 * 100 / std::sqrt(n));
}

TEST(HotPixels, AreAsManyAndAsHotAsAskedAndStayWhereTheyAre) {
  Detector d = plain;
  d.hot_pixel_fraction = 0.01;
  d.hot_pixel_e_per_s = 50;
  const ExpectedElectronImage dark(500, 400);
  const CountImage one = read_out(dark, d, 1), two = read_out(dark, d, 2);
  int hot = 0, moved = 0;
  for (std::size_t i = 0; i < one.pixels.size(); ++i) {
    hot += one.pixels[i] > 220;
    moved += (one.pixels[i] > 260) && two.pixels[i] <= 210;
  }
  EXPECT_NEAR(hot, 2000 * std::exp(-20.0 / 500), 4 * std::sqrt(2000.0));
  EXPECT_EQ(moved, 0);
  EXPECT_NEAR(mean(one), 0.01 * 500, 4 * 0.01 * 500 * std::sqrt(2.0 / 2000));
  EXPECT_NE(one.pixels, two.pixels);  // their noise is new
}

TEST(ColumnNoise, IsOneOffsetAColumnAndNewInEveryFrame) {
  Detector d = plain;
  d.column_noise_e = 20;
  const ExpectedElectronImage light(3000, 20, 100.0f);
  const CountImage one = read_out(light, d, 1), two = read_out(light, d, 2);
  double sum2 = 0, product = 0;
  for (int x = 0; x < 3000; ++x) {
    EXPECT_EQ(one.at(x, 0), one.at(x, 19));
    sum2 += std::pow(one.at(x, 0) - 300.0, 2);
    product += (one.at(x, 0) - 300.0) * (two.at(x, 0) - 300.0);
  }
  EXPECT_NEAR(std::sqrt(sum2 / 3000), 20, 4 * 20 / std::sqrt(6000.0));
  EXPECT_LT(std::abs(product / sum2), 4 / std::sqrt(3000.0));
}

TEST(Nonlinearity, LosesItsShareAtFullWellAndAQuarterOfThatShareAtAQuarter) {
  Detector d = plain;
  d.nonlinearity = 0.04;
  EXPECT_NEAR(mean(read_out(ExpectedElectronImage(4, 4, 60000.0f), d)), 60000 * 0.96, 1);
  EXPECT_NEAR(mean(read_out(ExpectedElectronImage(4, 4, 15000.0f), d)), 15000 * 0.99, 1);
}

// Moore, Ninkov & Forrest 2006: with coupling a to each neighbour, neighbouring noise correlates by
// about 2 a and the variance falls to about 1 - 8 a.
TEST(InterpixelCoupling, KeepsChargeAndCorrelatesNeighbours) {
  ElectronImage e(31, 17);
  e.at(10, 8) = 1000;
  e.at(0, 0) = 500;
  e.at(30, 16) = 200;
  std::vector<float> signal(e.pixels.size());
  couple(0.02, e, 0, signal);
  EXPECT_NEAR(std::accumulate(signal.begin(), signal.end(), 0.0), 1700, 1e-3);
  EXPECT_NEAR(signal[8 * 31 + 10], 920, 1e-3);
  EXPECT_NEAR(signal[8 * 31 + 11], 20, 1e-3);
  EXPECT_NEAR(signal[9 * 31 + 10], 20, 1e-3);
  EXPECT_NEAR(signal[0], 480, 1e-3);

  Detector d = plain;
  d.interpixel_coupling = 0.01;
  const CountImage image = read_out(ExpectedElectronImage(500, 500, 10000.0f), d, 1, {});
  double variance = 0, covariance = 0;
  for (int y = 0; y < 500; ++y)
    for (int x = 0; x < 499; ++x) {
      const double a = image.at(x, y) - 10200.0, b = image.at(x + 1, y) - 10200.0;
      variance += a * a, covariance += a * b;
    }
  EXPECT_NEAR(covariance / variance, 2 * 0.01 * 0.96 / (0.96 * 0.96 + 4e-4), 4 / 500.0);
  EXPECT_NEAR(variance / (500 * 499), 10000 * (0.96 * 0.96 + 4e-4),
              10000 * 4 * std::sqrt(2.0) / 500);
}

TEST(Blooming, FillsTheColumnBothWaysAndKeepsTheCharge) {
  ElectronImage e(5, 101);
  for (int y = 0; y < 101; ++y) e.at(2, y) = 10;
  e.at(2, 50) = 10 + 100 + 990;  // a well of 100 and eleven wells' room for the rest: 5.5 each way
  Threads one(1);
  EXPECT_EQ(bloom(100, e, one), 11u);
  double sum = 0;
  for (float v : e.pixels) sum += v;
  EXPECT_NEAR(sum, 1100 + 100 * 10, 1e-3);
  for (int y = 45; y <= 55; ++y) EXPECT_EQ(e.at(2, y), 100) << y;
  EXPECT_EQ(e.at(2, 44), e.at(2, 56));
  EXPECT_EQ(e.at(1, 50), 0);
}

TEST(Persistence, ReturnsWhatItTrappedWithItsTimeConstant) {
  Detector d = plain;
  d.persistence_fraction = 0.1;
  d.persistence_s = 50;
  DetectorMemory memory;
  ExpectedElectronImage light(8, 8, 20000.0f);
  read_out(light, d, 1, without_photon_noise(), &memory);
  light = ExpectedElectronImage(8, 8);
  const double released = 2000 * std::exp(-5.0 / 50) * (1 - std::exp(-10.0 / 50));
  EXPECT_NEAR(mean(read_out(light, d, 2, without_photon_noise(), &memory)), released, 1);
}

TEST(CosmicRays, AreAsManyAsAskedAndLeaveChargeByTheLengthOfTheirTracks) {
  Detector d = plain;
  d.cosmic_rays_per_px_s = 1e-4;
  d.cosmic_ray_e_per_px = 100;
  d.cosmic_ray_depth_px = 0.01;  // so thin that a track is a point unless it grazes
  const auto charges = d.charges(1000, 1000, 10, rng_key(1, "s", 1, "c"));
  EXPECT_NEAR(double(charges.size()), 1000, 4 * std::sqrt(1000.0) + 60);
  d.cosmic_ray_depth_px = 2;
  double sum = 0;
  for (const CosmicCharge& c : d.charges(1000, 1000, 10, rng_key(1, "s", 1, "c"))) {
    EXPECT_LE(c.electrons, 100 * std::hypot(std::sqrt(2.0), 2.0) * 100);
    sum += c.electrons;
  }
  // Mean length of isotropic flux through a slab: twice its depth; long tracks make it spread.
  EXPECT_NEAR(sum / 1000 / 100 / 2, 2.0, 0.3);
}

TEST(ReferencePixels, SeeNeitherLightNorDarkCurrent) {
  Detector d = plain;
  d.reference_px = 4;
  d.dark_e_per_s = 100;
  const CountImage image = read_out(ExpectedElectronImage(40, 30, 5000.0f), d);
  EXPECT_EQ(image.at(3, 15), 200);
  EXPECT_EQ(image.at(36, 15), 200);
  EXPECT_EQ(image.at(20, 3), 200);
  EXPECT_EQ(image.at(20, 26), 200);
  EXPECT_GT(image.at(4, 4), 5000);
}

TEST(Detector, AllItsEffectsTogetherGiveTheSameBytesOnAnyNumberOfThreads) {
  const Detector d = detector_of({.dark_e_per_s = 0.1,
                                  .read_noise_e = 5,
                                  .full_well_e = 20000,
                                  .gain_e_per_dn = 0.5,
                                  .bias_dn = 500,
                                  .prnu_rms = 0.01,
                                  .hot_pixel_fraction = 0.001,
                                  .hot_pixel_e_per_s = 100,
                                  .column_noise_e = 2,
                                  .nonlinearity = 0.01,
                                  .interpixel_coupling = 0.005,
                                  .blooming = true,
                                  .persistence_fraction = 0.01,
                                  .persistence_s = 100,
                                  .cosmic_rays_per_px_s = 1e-5,
                                  .reference_px = 4});
  ExpectedElectronImage light(701, 503, 200.0f);
  light.at(300, 200) = 1e6f;
  CountImage reference;
  for (int n : {1, 2, 4}) {
    Threads threads(n);
    CountImage counts;
    for (SimdLevel level : {SimdLevel::sse2, best_simd_level()}) {
      expose(light, d, {1, "s", 1, 10, 5}, {}, threads, counts, nullptr, {.level = level});
      if (reference.pixels.empty()) reference = counts;
      ASSERT_EQ(counts.pixels, reference.pixels) << n;
    }
  }
}

}  // namespace
}  // namespace dmise
