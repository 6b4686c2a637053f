#pragma once
#include <cstddef>
#include <cstdint>

#include "core/base/numeric/simd_sets.h"

namespace dmise {

/// The golden section of a turn of 2^32: any run of pixels has evenly spread values.
inline constexpr std::uint32_t dither_per_pixel = 0x9E3779B9u;

/// Columns that `mark_above` looks at together.
inline constexpr std::size_t filter_block = 32;

#define DMISE_FILTER_KERNELS(level)                                                               \
  namespace level {                                                                               \
  /* out[x] = weights[0] before[0][x] + sum over i = 1 .. radius of weights[i] (before[i][x] +    \
     after[i][x]). */                                                                             \
  void weigh_rows(const float* const* before, const float* const* after, const float* weights,    \
                  std::size_t radius, std::size_t count, float* out);                             \
  /* out[x] = counts[x] - sky[x]. */                                                              \
  void above_level(const std::uint16_t* counts, const float* sky, std::size_t count, float* out); \
  /* out[x] = counts[x] - sky[x] + mean, rounded and held to 16 bits. */                          \
  void flat_counts(const std::uint16_t* counts, const float* sky, float mean, std::size_t count,  \
                   std::uint16_t* out);                                                           \
  /* out[x] = first + weights[x] rise. */                                                         \
  void between_cells(const float* weights, float first, float rise, std::size_t count,            \
                     float* out);                                                                 \
  double sum_of_values(const float* values, std::size_t count);                                   \
  /* Whether a value of each block of columns is above `bar` noise[x]. */                         \
  void mark_above(const float* value, const float* noise, float bar, std::size_t count,           \
                  std::uint8_t* blocks);                                                          \
  /* out[x] = the step (FilteredFrame) of value[x] / (unit * noise[x]); `odd`: whether the first  \
     pixel's column plus row is. */                                                               \
  void steps_of(const float* value, const float* noise, float unit, std::size_t count, bool odd,  \
                std::int8_t* out);                                                                \
  /* Subtracts middle[0] + x middle[1] from the steps that are not 0 and multiplies what is left  \
     by scale[0] + x scale[1]. What was whole steps would round back to the same: so as to be     \
     right on average they are dithered by `dither` + x dither_per_pixel [2^-32 steps]. */        \
  void flatten_steps(std::int8_t* steps, std::size_t count, bool odd, std::uint32_t dither,       \
                     const float middle[2], const float scale[2]);                                \
  }
DMISE_EACH_SIMD_SET(DMISE_FILTER_KERNELS)
#undef DMISE_FILTER_KERNELS

}  // namespace dmise
