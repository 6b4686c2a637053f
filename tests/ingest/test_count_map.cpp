#include "core/ingest/count_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/parallel.h"
#include "core/detection/pixels/background.h"

namespace dmise {
namespace {

constexpr int side = 256;

std::vector<double> sky(double level, double sigma, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(level, sigma);
  std::vector<double> values(side * side);
  for (double& v : values) v = normal(random);
  return values;
}

TEST(CountMap, KeepsWholeNumbersOf16Bits) {
  auto values = sky(1000, 20);
  for (double& v : values) v = std::round(v);
  values[7] = 65535;
  const CountMap map = choose_count_map(values, side);
  EXPECT_TRUE(map.is_identity());
  PixelMask unusable;
  const CountImage counts = to_counts(values, side, map, unusable);
  EXPECT_TRUE(unusable.pixels.empty());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(counts.pixels[i], values[i]);
}

// Counts of 12 and 14 bits as 16: a noise of 0.45 of a step, sqrt(0.45^2 + 1/12) = 0.535 after
// rounding. In steps of 16 counts the noise would be measured as less than a count.
TEST(CountMap, PaddedCountsGoBackToTheirSteps) {
  for (const auto& [step, zero] : {std::pair{16.0, 0.0}, {4.0, 3.0}}) {
    auto values = sky(100, 0.45);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i % 997 == 0) values[i] += double(i % 1500);  // stars
      values[i] = zero + step * std::round(values[i]);
    }
    values[500] = 65535;  // clipped after padding
    const CountMap map = choose_count_map(values, side);
    EXPECT_EQ(map.step, step);
    EXPECT_EQ(map.zero, zero);
    PixelMask unusable;
    const CountImage counts = to_counts(values, side, map, unusable);
    Threads one(1);
    EXPECT_NEAR(map.step * double(Background(counts, 64, one).median_sigma_dn()), 0.535 * step,
                0.05 * step);
  }
}

TEST(CountMap, ShiftsWholeNumbersBelowZero) {
  auto values = sky(0, 20);
  for (double& v : values) v = std::round(v);
  const CountMap map = choose_count_map(values, side);
  EXPECT_EQ(map.step, 1.0);
  EXPECT_LT(map.zero, -40);
}

// Normalised floats, as stacking programs write them, and counts of 32 bits.
TEST(CountMap, StepsAreAnEighthOfTheNoiseAtMost) {
  for (const auto& [level, sigma] : {std::pair{0.01, 2e-4}, {-3.0, 1.0}, {1e6, 800.0}}) {
    auto values = sky(level, sigma);
    values[100] = level + 1e5 * sigma;  // a star that is clipped
    const CountMap map = choose_count_map(values, side);
    EXPECT_LE(map.step, sigma / 8);
    PixelMask unusable;
    const CountImage counts = to_counts(values, side, map, unusable);
    EXPECT_EQ(counts.pixels[100], 65535);
    for (std::size_t i = 101; i < values.size(); ++i)
      EXPECT_NEAR(map.zero + map.step * counts.pixels[i], values[i], 0.501 * map.step);
  }
}

// Fill values, and quotients by a dead pixel of a flat.
TEST(CountMap, NoPixelCostsTheOthersTheirSteps) {
  for (const double outlier : {1e20, 3e12, -3e12, -1e20}) {
    auto values = sky(1000, 20);
    values[100] = outlier;
    EXPECT_LE(choose_count_map(values, side).step, 20.0 / 8) << outlier;
  }
}

TEST(CountMap, NoiseIsMeasuredBesideStarsAndSlopes) {
  auto values = sky(100, 5);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      values[std::size_t(y * side + x)] += 0.3 * x;
      if (x % 16 < 2 && y % 16 < 2) values[std::size_t(y * side + x)] += 500;
    }
  EXPECT_NEAR(pixel_noise(values, side), 5, 0.4);
}

TEST(CountMap, PixelsWithoutAValueLookLikeTheSkyAroundThem) {
  auto values = sky(5, 0.1);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      if (x < 100 || (x == 180 && y > 30)) values[std::size_t(y * side + x)] = NAN;
  const CountMap map = choose_count_map(values, side);
  PixelMask unusable;
  const CountImage counts = to_counts(values, side, map, unusable);
  ASSERT_EQ(unusable.pixels.size(), values.size());
  Threads one(1);
  const Background background(counts, 64, one);
  for (int x = 0; x < side; x += 16) {
    EXPECT_NEAR(map.zero + map.step * background.level_dn(x, 128), 5, 0.02) << x;
    EXPECT_NEAR(map.step * background.sigma_dn(x, 128), 0.1, 0.01) << x;
    EXPECT_EQ(unusable.at(x, 128) == 1, x < 100) << x;
  }
  EXPECT_EQ(unusable.at(180, 128), 1);
}

TEST(CountMap, FindsTheCeilingOfClippedPixels) {
  auto values = sky(1000, 20);
  EXPECT_EQ(find_ceiling(values).pixels, 0u);
  for (std::size_t i = 0; i < 12; ++i) values[i * 100] = 16383;
  EXPECT_EQ(find_ceiling(values).pixels, 12u);
  EXPECT_EQ(find_ceiling(values).value, 16383);
  EXPECT_EQ(find_ceiling(std::vector<double>(100, 7.0)).pixels, 0u);
}

TEST(CountMap, TakesImagesOfOneValue) {
  const std::vector<double> values(100, 0.125);
  PixelMask unusable;
  const CountImage counts = to_counts(values, 10, choose_count_map(values, 10), unusable);
  EXPECT_EQ(counts.pixels, std::vector<std::uint16_t>(100, counts.pixels[0]));
}

}  // namespace
}  // namespace dmise
