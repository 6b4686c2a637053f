#pragma once
#include "core/base/numeric/rng.h"
#include "core/base/numeric/simd_sets.h"

// The loops of rng.cpp, compiled once per instruction set.
#define DMISE_RNG_KERNELS(level)                                                             \
  namespace dmise::level {                                                                   \
  /* rng_words for `first` and `count` that are multiples of rng_group. */                   \
  void rng_groups(const RngKey&, std::uint32_t first, std::size_t count, std::uint32_t draw, \
                  std::uint32_t* out);                                                       \
  void rng_words_at(const RngKey&, const std::uint32_t* pixels, std::size_t count,           \
                    std::uint32_t draw, std::uint32_t* out);                                 \
  void normals_of(const std::uint32_t* words, std::size_t count, float* out);                \
  }
DMISE_EACH_SIMD_SET(DMISE_RNG_KERNELS)
#undef DMISE_RNG_KERNELS
