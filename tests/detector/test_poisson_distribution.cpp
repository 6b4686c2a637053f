#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <vector>

#include "core/base/parallel.h"
#include "core/detector/noise/poisson.h"

// 10^8 draws at each of many means against the probabilities by the C library's lgammal.
namespace dmise {
namespace {

constexpr std::size_t draws = 100'000'000;
constexpr std::size_t piece = 1 << 14;
constexpr double fewest_expected = 20.0;  // in a bin
constexpr double bins_wanted = 200.0;

/// A bin for each value, or of about equal probability where there are many. Deviates above 2^24
/// are rounded to single precision, and so are the values whose probabilities are summed.
class Bins {
 public:
  explicit Bins(double mean) {
    const double spread = 8 * std::sqrt(mean) + 40;
    low_ = std::int64_t(std::max(0.0, std::floor(mean - spread)));
    const auto high = std::int64_t(mean + spread);
    granule_ = std::max(1.0, double(std::nextafterf(float(mean), 1e30f)) - double(float(mean)));
    low_ -= low_ % std::int64_t(granule_);
    bin_of_.resize(std::size_t(double(high - low_) / granule_) + 2);
    std::vector<double> probability(bin_of_.size(), 0.0);
    for (std::int64_t k = low_; k <= high; ++k)
      probability[cell(float(k))] += double(std::exp(
          k * std::log((long double)mean) - (long double)mean - lgammal((long double)k + 1)));
    const bool many = probability.size() > 2 * bins_wanted;
    const double least = many ? 1.0 / bins_wanted : fewest_expected / double(draws);
    double sum = 0.0, left = 1.0;
    for (std::size_t c = 0; c < probability.size(); ++c) {
      sum += probability[c];
      left -= probability[c];
      bin_of_[c] = std::uint16_t(expected_.size());
      if (sum >= least && left >= least) {
        expected_.push_back(sum);
        sum = 0.0;
      }
    }
    expected_.push_back(sum + std::max(0.0, left));
  }

  std::size_t count() const { return expected_.size(); }
  std::size_t operator()(float deviate) const { return bin_of_[cell(deviate)]; }

  /// (chi-square - degrees) / sqrt(2 degrees).
  double chi_square_sigmas(const std::vector<std::uint64_t>& seen) const {
    double n = 0, chi = 0;
    for (const auto s : seen) n += double(s);
    for (std::size_t b = 0; b < expected_.size(); ++b)
      chi += std::pow(double(seen[b]) - n * expected_[b], 2) / (n * expected_[b]);
    const double degrees = double(expected_.size()) - 1;
    return (chi - degrees) / std::sqrt(2 * degrees);
  }

 private:
  std::size_t cell(float deviate) const {
    const double c = (double(deviate) - double(low_)) / granule_;
    return std::size_t(std::min(std::max(c, 0.0), double(bin_of_.size() - 1)));
  }
  std::int64_t low_ = 0;
  double granule_ = 1.0;
  std::vector<std::uint16_t> bin_of_;
  std::vector<double> expected_;
};

/// Draws of means[i % means.size()] in turn; what was seen of each mean.
std::vector<std::vector<std::uint64_t>> histograms(const std::vector<float>& means,
                                                   const std::vector<Bins>& bins) {
  const RngKey key = rng_key(7, "sensor", 1, "photon_noise");
  std::vector<float> pattern(piece);
  for (std::size_t i = 0; i < piece; ++i) pattern[i] = means[i % means.size()];
  std::vector<std::vector<std::uint64_t>> seen;
  for (const Bins& b : bins) seen.emplace_back(b.count());
  std::mutex sums;
  Threads two(2);
  two.for_ranges(draws, piece, [&](std::size_t begin, std::size_t end) {
    thread_local std::vector<float> deviates(piece);
    poisson(key, std::uint32_t(begin), pattern.data(), end - begin, deviates.data());
    std::vector<std::vector<std::uint64_t>> here;
    for (const Bins& b : bins) here.emplace_back(b.count());
    for (std::size_t i = 0; i < end - begin; ++i) {
      const std::size_t m = means.size() == 1 ? 0 : i % means.size();
      ++here[m][bins[m](deviates[i])];
    }
    std::lock_guard lock(sums);
    for (std::size_t m = 0; m < here.size(); ++m)
      for (std::size_t b = 0; b < here[m].size(); ++b) seen[m][b] += here[m][b];
  });
  return seen;
}

class PoissonDistribution : public testing::TestWithParam<std::vector<float>> {};

TEST_P(PoissonDistribution, IsExactAsFarAsAHundredMillionDrawsCanSee) {
  std::vector<Bins> bins;
  for (float mean : GetParam()) bins.emplace_back(mean);
  const auto seen = histograms(GetParam(), bins);
  for (std::size_t m = 0; m < seen.size(); ++m)
    EXPECT_LT(std::abs(bins[m].chi_square_sigmas(seen[m])), 4.0) << GetParam()[m];
}

// Branches: sums below 24 and the expansion above, both in one vector of pixels, the whole part
// held aside below 2^23, rounding to single precision above 2^24.
INSTANTIATE_TEST_SUITE_P(OnBothSidesOfEveryBranch, PoissonDistribution,
                         testing::Values(std::vector{1e-6f}, std::vector{1e-3f}, std::vector{5.0f},
                                         std::vector{std::nextafterf(24.0f, 0.0f)},
                                         std::vector{24.0f}, std::vector{23.9f, 24.1f},
                                         std::vector{0x1p23f - 1.0f}, std::vector{0x1p23f},
                                         std::vector{1e9f}));

}  // namespace
}  // namespace dmise
