#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "core/base/error.h"
#include "core/detector/noise/poisson.h"

namespace dmise {
namespace {

const RngKey key = rng_key(20, "sensor", 1, "photon_noise");

double log_probability(double mean, double k) {
  return k * std::log(mean) - mean - std::lgamma(k + 1);
}

// Chi-square of `draws` deviates against the probabilities by the C library's lgamma, in units of
// its own standard deviation. Bins with fewer than ten expected draws are joined with their
// neighbours.
double chi_square_sigmas(float mean, std::size_t draws) {
  const double spread = 12 * std::sqrt(double(mean)) + 40;
  const auto low = std::int64_t(std::max(0.0, std::floor(mean - spread)));
  const auto bins = std::size_t(std::int64_t(mean + spread) - low + 1);
  std::vector<double> seen(bins, 0.0), expected(bins, 0.0);
  std::vector<float> means(1 << 16, mean), deviates(1 << 16);
  for (std::size_t done = 0; done < draws; done += deviates.size()) {
    poisson(key, std::uint32_t(done), means.data(), means.size(), deviates.data());
    for (float n : deviates) {
      const std::int64_t bin = std::int64_t(n) - low;
      if (bin < 0 || bin >= std::int64_t(bins)) return 1e9;
      seen[std::size_t(bin)] += 1;
    }
  }
  for (std::size_t b = 0; b < bins; ++b)
    expected[b] = double(draws) * std::exp(log_probability(mean, double(low) + double(b)));
  double chi = 0, s = 0, e = 0;
  int degrees = -1;
  double left = double(draws);
  for (std::size_t b = 0; b < bins; ++b) {
    s += seen[b], e += expected[b], left -= expected[b];
    if (e < 10 || left < 10) continue;
    chi += (s - e) * (s - e) / e;
    ++degrees;
    s = e = 0;
  }
  if (e > 0) {
    chi += (s - e) * (s - e) / std::max(e, 1.0);
    ++degrees;
  }
  return degrees > 0 ? (chi - degrees) / std::sqrt(2.0 * degrees) : 0.0;
}

TEST(Poisson, IsDistributedAsPoissonOnBothSidesOfTheSwitchAndFarFromIt) {
  constexpr std::size_t draws = 1 << 23;
  for (float mean :
       {1e-6f, 1e-3f, 0.1f, 1.0f, 5.0f, 10.0f, 23.99f, 24.0f, 24.01f, 32.5f, 100.0f, 1000.0f, 1e4f})
    EXPECT_LT(std::abs(chi_square_sigmas(mean, draws)), 4.0) << mean;
}

// Mean, variance and third moment of the distribution: mean, mean, mean.
TEST(Poisson, KeepsItsMomentsUpToABillion) {
  constexpr std::size_t draws = 1 << 22;
  for (float mean : {1e-6f, 0.3f, 23.5f, 24.5f, 1e5f, 1e6f, 1e9f}) {
    std::vector<float> means(draws, mean), n(draws);
    poisson(key, 0, means.data(), draws, n.data());
    double first = 0, second = 0, third = 0;
    for (float v : n) {
      const double d = double(v) - mean;
      first += d, second += d * d, third += d * d * d;
    }
    const double count = double(draws), m = mean;
    EXPECT_LT(std::abs(first / count), 4 * std::sqrt(m / count)) << mean;
    EXPECT_LT(std::abs(second / count - m), 4 * std::sqrt((m + 2 * m * m) / count)) << mean;
    EXPECT_LT(std::abs(third / count - m), 4 * std::sqrt((m + 24 * m * m + 15 * m * m * m) / count))
        << mean;
  }
}

TEST(Poisson, ZeroAndTinyMeansGiveNothing) {
  for (float mean : {0.0f, 1e-30f, 1e-40f, 1e-12f}) {
    std::vector<float> means(100000, mean), n(means.size(), 9.0f);
    poisson(key, 0, means.data(), means.size(), n.data());
    EXPECT_EQ(std::accumulate(n.begin(), n.end(), 0.0), 0.0) << mean;
  }
}

TEST(Poisson, NoMeanIsRefusedWithItsPixel) {
  for (float bad : {-1.0f, -1e-30f, std::numeric_limits<float>::quiet_NaN(),
                    std::numeric_limits<float>::infinity()}) {
    std::vector<float> means(1000, 5.0f);
    means[717] = bad;
    try {
      poisson(key, 5, means.data(), means.size(), means.data());
      FAIL() << bad;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("pixel 722"), std::string::npos) << e.what();
    }
  }
}

TEST(Poisson, ADeviateNeverFallsWhenItsMeanGrows) {
  std::vector<float> before(4096, 0.0f), means(4096), n(4096);
  for (float mean = 0.01f; mean < 1e5f; mean *= 1.05f) {
    std::fill(means.begin(), means.end(), mean);
    poisson(key, 0, means.data(), means.size(), n.data());
    for (std::size_t i = 0; i < n.size(); ++i) ASSERT_GE(n[i], before[i]) << mean;
    before = n;
  }
}

std::vector<float> mixed_means(std::size_t count) {
  std::vector<float> means(count);
  for (std::size_t i = 0; i < count; ++i)
    means[i] = float(std::exp(uniform_of(rng_word(key, std::uint32_t(i), 9)) * 30 - 12));
  return means;
}

TEST(Poisson, TheBytesAreTheSameOnEveryInstructionSetAndHoweverPixelsAreGrouped) {
  const auto means = mixed_means(100003);
  std::vector<float> reference(means.size()), other(means.size());
  poisson(key, 0, means.data(), means.size(), reference.data(), SimdLevel::sse2);
  for (SimdLevel level : {SimdLevel::sse2, SimdLevel::avx2, SimdLevel::avx512}) {
    if (level > best_simd_level()) continue;
    for (std::size_t piece : {100003u, 1000u, 7u}) {
      for (std::size_t i = 0; i < means.size(); i += piece)
        poisson(key, std::uint32_t(i), means.data() + i, std::min(piece, means.size() - i),
                other.data() + i, level);
      ASSERT_EQ(reference, other) << name(level) << " " << piece;
    }
  }
}

TEST(Poisson, AConstantMeanGivesTheDeviatesOfTheGeneralWay) {
  for (float mean : {0.0f, 1e-4f, 0.2f, 3.0f, 23.9f, 24.0f, 500.0f}) {
    std::vector<float> n(50001, mean), sum(n.size(), 0.0f);
    poisson(key, 3, n.data(), n.size(), n.data());
    for (SimdLevel level : {SimdLevel::sse2, SimdLevel::avx2, SimdLevel::avx512}) {
      if (level > best_simd_level()) continue;
      std::fill(sum.begin(), sum.end(), 0.0f);
      ConstantPoisson(mean).add(key, 3, sum.data(), sum.size(), level);
      ASSERT_EQ(n, sum) << mean << name(level);
    }
  }
}

}  // namespace
}  // namespace dmise
