#include "core/detection/pixels/background.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dmise {
namespace {

CountImage noise(int columns, int rows, double level, double slope, double sigma, unsigned seed) {
  CountImage counts(columns, rows);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      counts.at(x, y) = std::uint16_t(std::lround(level + slope * x + sigma * normal(random)));
  return counts;
}

TEST(Background, LevelAndNoiseOfAPlainSky) {
  Threads threads;
  for (const double sigma : {1.0, 20.0}) {  // also where the noise is of the size of one count
    const Background b(noise(640, 512, 1000, 0, sigma, 1), 64, threads);
    for (int y = 30; y < 512; y += 90)
      for (int x = 30; x < 640; x += 90) {
        EXPECT_NEAR(b.level_dn(x, y), 1000, 0.1 * sigma);
        const double counted = std::sqrt(sigma * sigma + 1.0 / 12);  // with the rounding to counts
        EXPECT_NEAR(b.sigma_dn(x, y), counted, 0.05 * sigma);
      }
  }
}

TEST(Background, FollowsAGradient) {
  Threads threads;
  const Background b(noise(640, 512, 1000, 0.5, 10, 2), 64, threads);
  for (int x = 4; x < 640; x += 40) EXPECT_NEAR(b.level_dn(x, 250), 1000 + 0.5 * x, 2.0);
}

TEST(Background, AGradientIsNoNoise) {
  Threads threads;
  for (const double slope : {0.5, 5.0, 40.0}) {  // DN per px; 40 is 2,560 over a cell
    const Background b(noise(640, 512, 1000, slope, 10, 3), 64, threads);
    for (int x = 40; x < 640; x += 40) EXPECT_NEAR(b.sigma_dn(x, 250), 10, 0.6) << slope;
  }
}

// A glow of 4000 DN that falls to a half over 120 px, in a noise of 30.
TEST(Background, FollowsAGlow) {
  CountImage counts = noise(900, 900, 2000, 1, 30, 5);
  const auto glow = [](int x, int y) {
    const double r = std::hypot(x - 450.0, y - 450.0) / 120;
    return 4000 / (1 + r * r);
  };
  for (int y = 0; y < counts.rows; ++y)
    for (int x = 0; x < counts.columns; ++x)
      counts.at(x, y) = std::uint16_t(std::lround(counts.at(x, y) + glow(x, y)));
  Threads threads;
  const Background b(counts, 64, threads);
  double squares = 0.0;
  int count = 0;
  for (int y = 20; y < 880; y += 7)
    for (int x = 20; x < 880; x += 7) {
      if (std::hypot(x - 450.0, y - 450.0) < 250) continue;
      const double off = b.level_dn(x, y) - (2000 + x + glow(x, y));
      EXPECT_LT(std::abs(off), 0.4 * 30) << x << " " << y;
      squares += off * off;
      ++count;
    }
  EXPECT_LT(std::sqrt(squares / count), 0.1 * 30);
}

// Cells on a slope are measured twice: a source that lifted the first measurement is in neither.
TEST(Background, OneSourceInTwentyPixelsHardlyLiftsASlope) {
  auto counts = noise(512, 512, 1000, 3, 10, 6);
  for (int y = 3; y < 512; y += 20)
    for (int x = 3; x < 500; x += 20)
      for (int i = 0; i < 20; ++i) counts.at(x + i % 5, y + i / 5) += 300;
  Threads threads;
  const Background b(counts, 64, threads);
  for (int x = 40; x < 480; x += 40) EXPECT_NEAR(b.level_dn(x, 250), 1000 + 3 * x, 3.0);
}

TEST(Background, OneSourceInTwentyPixelsHardlyLiftsIt) {
  auto counts = noise(512, 512, 1000, 0, 10, 3);
  for (int y = 3; y < 512; y += 20)
    for (int x = 3; x < 500; x += 20)
      for (int i = 0; i < 20; ++i) counts.at(x + i % 5, y + i / 5) += 300;
  Threads threads;
  const Background b(counts, 64, threads);
  EXPECT_NEAR(b.median_level_dn(), 1000, 1.0);
  EXPECT_NEAR(b.median_sigma_dn(), 10, 0.5);
}

/// Stars of 3 x 3 pixels, 30 of noise, on a share of the cells' pixels, and where they are.
BitMask add_stars(CountImage& counts, double share) {
  BitMask lit(counts.columns, counts.rows);
  std::mt19937_64 random(7);
  const auto below = [&](int n) { return int(random() % std::uint64_t(n)); };
  const int stars = int(share * counts.columns * counts.rows / 9);
  for (int k = 0; k < stars; ++k) {
    const int x = below(counts.columns - 2), y = below(counts.rows - 2);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        lit.set(x + i, y + j);
        counts.at(x + i, y + j) = std::uint16_t(counts.at(x + i, y + j) + 30);
      }
  }
  return lit;
}

TEST(Background, KnownStarsLiftNeitherLevelNorNoise) {
  Threads threads;
  CountImage counts = noise(640, 512, 1000, 0.5, 20, 6);
  const BitMask lit = add_stars(counts, 0.4);
  const Background with(counts, 64, threads);
  Background beside = with;
  beside.measure_without(lit, counts, threads);
  EXPECT_GT(with.median_sigma_dn(), 21.0);
  EXPECT_NEAR(beside.median_sigma_dn(), 20.0, 0.2);
  for (int x = 40; x < 640; x += 40) {
    EXPECT_NEAR(beside.level_dn(x, 250), 1000 + 0.5 * x, 2.0);
    EXPECT_GT(with.level_dn(x, 250), 1000 + 0.5 * x + 3.0);
  }
}

TEST(Background, WhereAllIsLitAllPixelsAreTaken) {
  Threads threads;
  const CountImage counts = noise(128, 128, 1000, 0, 20, 8);
  BitMask lit(128, 128);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x)
      if (x % 16 != 0) lit.set(x, y);
  const Background all(counts, 64, threads);
  Background few = all;
  few.measure_without(lit, counts, threads);
  EXPECT_EQ(all.level_dn(60, 60), few.level_dn(60, 60));
  EXPECT_EQ(all.sigma_dn(60, 60), few.sigma_dn(60, 60));
}

TEST(Background, RowAndPixelAgree) {
  Threads threads;
  const Background b(noise(200, 150, 1000, 0.7, 10, 4), 64, threads);
  std::vector<float> level(200), sigma(200);
  b.level_row(77, 0, 200, level.data());
  b.sigma_row(77, 0, 200, sigma.data());
  for (int x = 0; x < 200; ++x) {
    EXPECT_FLOAT_EQ(level[std::size_t(x)], b.level_dn(x, 77));
    EXPECT_FLOAT_EQ(sigma[std::size_t(x)], b.sigma_dn(x, 77));
  }
}

}  // namespace
}  // namespace dmise
