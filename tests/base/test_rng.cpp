#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/numeric/rng.h"

namespace dmise {
namespace {

using Block = std::array<std::uint32_t, 4>;

// Reference: known-answer vectors of Random123 1.14, "philox4x32 10".
TEST(Rng, BlocksAreThePublishedPhilox) {
  EXPECT_EQ(rng_block({{0, 0}, {0, 0}}, 0, 0),
            (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(rng_block({{0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}}, 0xffffffff, 0xffffffff),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(rng_block({{0xa4093822, 0x299f31d0}, {0x13198a2e, 0x03707344}}, 0x243f6a88, 0x85a308d3),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Rng, EverythingThatNamesAStreamChangesIt) {
  const RngKey base = rng_key(1, "atlanta", 1, "photon_noise");
  EXPECT_EQ(base, rng_key(1, "atlanta", 1, "photon_noise"));
  for (const RngKey& other :
       {rng_key(2, "atlanta", 1, "photon_noise"), rng_key(1, "atlantb", 1, "photon_noise"),
        rng_key(1, "atlanta", 2, "photon_noise"), rng_key(1, "atlanta", 1, "read_noise"),
        rng_key(1, "atlant", 1, "aphoton_noise")})
    EXPECT_NE(rng_word(base, 0, 0), rng_word(other, 0, 0));
}

TEST(Rng, ARunOfPixelsIsTheSameOnEveryInstructionSetAndFromAnyFirstPixel) {
  const RngKey key = rng_key(7, "s", 3, "e");
  for (SimdLevel level : {SimdLevel::sse2, SimdLevel::avx2, SimdLevel::avx512}) {
    if (level > best_simd_level()) continue;
    for (std::uint32_t first : {0u, 1u, 31u, 32u, 4294967200u})
      for (std::size_t count : {0, 1, 31, 64, 95}) {
        std::vector<std::uint32_t> words(count);
        rng_words(key, first, count, 5, words.data(), level);
        for (std::size_t i = 0; i < count; ++i)
          ASSERT_EQ(words[i], rng_word(key, first + std::uint32_t(i), 5)) << name(level);
      }
  }
}

TEST(Rng, NormalsOfARunOfPixelsAreThoseOfTheirWords) {
  const RngKey key = rng_key(7, "s", 3, "e");
  std::vector<float> normals(2500);
  rng_normals(key, 77, 5, normals);
  for (std::size_t i = 0; i < normals.size(); ++i)
    ASSERT_EQ(normals[i], normal_of(rng_word(key, 77 + std::uint32_t(i), 5))) << i;
}

// Reference: the normal distribution function by the C library's erfc.
TEST(Rng, NormalsAreTheQuantileFunctionToSinglePrecision) {
  for (std::uint64_t k = 0; k <= 4096; ++k) {
    const auto word = std::uint32_t(std::min<std::uint64_t>(k << 20, 0xffffffffu));
    const double z = normal_of(word), u = uniform_of(word);
    const double tail = z < 0 ? u : 1.0 - u;
    const double residual = 0.5 * std::erfc(std::abs(z) / std::sqrt(2.0)) - tail;
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2 * 3.14159265358979);
    EXPECT_LT(std::abs(residual / density), 1.2e-6 * (1 + std::abs(z))) << k;
    EXPECT_EQ(normal_of(~word), -float(z));
  }
}

TEST(Rng, NormalsInTheTailAreTheQuantileFunctionToo) {
  for (std::uint32_t word = 0; word < 20'000'000; word = word * 5 / 4 + 1) {
    const double z = normal_of(word), u = uniform_of(word);
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2 * 3.14159265358979);
    const double error = (0.5 * std::erfc(-z / std::sqrt(2.0)) - u) / density;
    EXPECT_LT(std::abs(error), 1.2e-6 * (1 + std::abs(z))) << word;
  }
}

TEST(Rng, NormalsAreTheSameBytesOnEveryInstructionSet) {
  std::vector<std::uint32_t> words(100003);
  rng_words(rng_key(1, "s", 1, "e"), 0, words.size(), 0, words.data());
  std::vector<float> reference(words.size()), other(words.size());
  normals_of(words.data(), words.size(), reference.data(), SimdLevel::sse2);
  double sum = 0, sum2 = 0, sum4 = 0;
  for (float z : reference) sum += z, sum2 += double(z) * z, sum4 += std::pow(z, 4);
  const double n = double(words.size());
  EXPECT_NEAR(sum / n, 0.0, 4 / std::sqrt(n));
  EXPECT_NEAR(sum2 / n, 1.0, 4 * std::sqrt(2 / n));
  EXPECT_NEAR(sum4 / n, 3.0, 4 * std::sqrt(96 / n));
  for (SimdLevel level : {SimdLevel::avx2, SimdLevel::avx512}) {
    if (level > best_simd_level()) continue;
    normals_of(words.data(), words.size(), other.data(), level);
    EXPECT_EQ(reference, other) << name(level);
  }
}

}  // namespace
}  // namespace dmise
