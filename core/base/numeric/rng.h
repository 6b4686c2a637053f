#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/numeric/simd_level.h"

// Random numbers as a pure function of (seed, sensor name, frame, effect name, pixel). There is no
// state and no order: any thread may draw any pixel, and adding an effect does not change the
// numbers of the others. Philox4x32-10 of Salmon, Moraes, Dror & Shaw 2011 (SC'11).
namespace dmise {

/// Key of a stream of random numbers, one per (seed, sensor, frame, effect).
struct RngKey {
  std::array<std::uint32_t, 2> key{};     // Philox's: hash of seed, sensor and effect
  std::array<std::uint32_t, 2> stream{};  // counter words 2 and 3: frame, more of the hash

  bool operator==(const RngKey&) const = default;
};

RngKey rng_key(std::uint64_t seed, std::string_view sensor, std::uint32_t frame,
               std::string_view effect);

/// Four uniform 32-bit words of block `block` and draw `draw`.
std::array<std::uint32_t, 4> rng_block(const RngKey& key, std::uint32_t block, std::uint32_t draw);

/// Pixels share blocks in groups of 32 (so that vectors of any width can be filled without
/// shuffling): pixel 32 g + i has word 2 (i / 16) + i % 2 of block 8 g + (i % 16) / 2.
inline constexpr std::uint32_t rng_group = 32;

/// The uniform 32-bit word of a pixel (or any other index). Draws 0, 1, 2, ... of one pixel are
/// independent.
std::uint32_t rng_word(const RngKey& key, std::uint32_t pixel, std::uint32_t draw);

/// Words of `count` consecutive pixels from `first`: out[i] = rng_word(key, first + i, draw).
void rng_words(const RngKey& key, std::uint32_t first, std::size_t count, std::uint32_t draw,
               std::uint32_t* out, SimdLevel level = best_simd_level());

/// Uniform in (0, 1), 2^-33 from both ends; exact in double.
constexpr double uniform_of(std::uint32_t word) { return (double(word) + 0.5) * 0x1p-32; }

/// Standard normal deviate of a word: the quantile function at `uniform_of(word)`, in single
/// precision with an error below 1.2e-6 (relative to 1 + |z|); |z| <= 6.34. Odd about the median.
/// Gives the same bytes on every processor: additions, multiplications, divisions and square roots
/// only.
float normal_of(std::uint32_t word);
void normals_of(const std::uint32_t* words, std::size_t count, float* out,
                SimdLevel level = best_simd_level());
/// Normal deviates of consecutive pixels: out[i] = normal_of(rng_word(key, first + i, draw)).
void rng_normals(const RngKey& key, std::uint32_t first, std::uint32_t draw, std::span<float> out);

}  // namespace dmise
