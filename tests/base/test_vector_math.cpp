#include "core/base/numeric/vector_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/base/error.h"
#include "core/base/numeric/rng_at.h"

namespace dmise {
namespace {

std::vector<double> numbers(double low, double high, std::size_t count) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(low, high);
  std::vector<double> x(count);
  for (double& value : x) value = uniform(random);
  x[0] = low, x[1] = high, x[2] = 0.0;
  return x;
}

// Reference: the C library in extended precision.
TEST(VectorMath, TheExponentialIsThatOfTheCLibrary) {
  for (const double most : {1e-8, 1.0, 40.0, 700.0}) {
    const std::vector<double> x = numbers(-most, most, 20011);
    std::vector<double> y(x.size());
    exp_of(x, y);
    for (std::size_t i = 0; i < x.size(); ++i)
      ASSERT_LT(std::abs(y[i] / std::exp(static_cast<long double>(x[i])) - 1), 4e-16) << x[i];
  }
}

TEST(VectorMath, TheExponentialIsFiniteForEveryNumber) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> x{-infinity, -1e300, 1e300, infinity, std::nan("")};
  exp_of(x, x);
  for (const double y : x) EXPECT_TRUE(std::isfinite(y) && y > 0);
}

TEST(VectorMath, TheLogarithmIsThatOfTheCLibrary) {
  for (const double most : {1e-9, 1e-3, 1.0}) {
    const std::vector<double> x = numbers(0.0, most, 20011);
    std::vector<double> y(x.size());
    log1p_of(x, y);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const long double exact = std::log1p(static_cast<long double>(x[i]));
      ASSERT_LE(std::abs(y[i] - exact), 1e-15L * exact) << x[i];
    }
  }
}

TEST(VectorMath, HasTheSameBytesOnEveryInstructionSetAndForAnyCount) {
  for (const std::size_t count : {3, 4, 5, 8, 15, 1001}) {
    const std::vector<double> x = numbers(-100, 100, count), small = numbers(0, 1, count);
    std::vector<double> e(count), l(count), other(count);
    exp_of(x, e, SimdLevel::sse2);
    log1p_of(small, l, SimdLevel::sse2);
    for (const SimdLevel level : {SimdLevel::avx2, SimdLevel::avx512}) {
      if (level > best_simd_level()) continue;
      exp_of(x, other, level);
      EXPECT_EQ(other, e) << name(level);
      log1p_of(small, other, level);
      EXPECT_EQ(other, l) << name(level);
    }
  }
  std::vector<double> two(2), three(3);
  EXPECT_THROW(exp_of(two, three), Error);
}

TEST(RngAt, HasTheWordOfEveryPixelOnEveryInstructionSet) {
  const RngKey key = rng_key(7, "s", 3, "e");
  std::mt19937 random(1);
  for (const std::size_t count : {0, 1, 7, 32, 33, 500}) {
    std::vector<std::uint32_t> pixels(count), words(count);
    for (std::uint32_t& pixel : pixels) pixel = std::uint32_t(random());
    for (const SimdLevel level : {SimdLevel::sse2, SimdLevel::avx2, SimdLevel::avx512}) {
      if (level > best_simd_level()) continue;
      rng_words_at(key, pixels, 5, words, level);
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_EQ(words[i], rng_word(key, pixels[i], 5)) << name(level);
    }
  }
}

}  // namespace
}  // namespace dmise
