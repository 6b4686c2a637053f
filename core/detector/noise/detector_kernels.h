#pragma once
#include <cstddef>
#include <cstdint>

#include "core/base/numeric/rng.h"
#include "core/base/numeric/simd_level.h"

// The detector's loops over pixels, compiled once per instruction set. `first` is a multiple of
// rng_group.
namespace dmise {

#define DMISE_DETECTOR_KERNELS(level)                                                              \
  namespace level {                                                                                \
  /* Stops before a group of pixels in which a mean is not in 0..1e12; returns how far it came. */ \
  std::size_t poisson(const RngKey& key, std::uint32_t first, const float* mean,                   \
                      std::size_t count, float* out);                                              \
  /* P(N <= k) for k = 0, 1, ... until it rounds to 1 for 52 bits; returns how many. */            \
  int poisson_cumulative(float mean, double* cumulative);                                          \
  /* sum += how many thresholds the pixel's word exceeds; true when one equals the word. */        \
  bool add_exceeded(const RngKey& key, std::uint32_t first, const std::uint32_t* thresholds,       \
                    int steps, float* sum, std::size_t count);                                     \
  void add_normal(const RngKey& key, std::uint32_t first, float sigma, float* sum,                 \
                  std::size_t count);                                                              \
  /* e += offset + sqrt(e + offset + variance) x a normal deviate; e + offset held at 0 below. */  \
  void add_normal_of_light(const RngKey& key, std::uint32_t first, float offset, float variance,   \
                           float* e, std::size_t count);                                           \
  /* out = in, 4e11 at most; false when a value is negative, infinite or NaN. */                   \
  bool copy_light(const float* in, std::size_t count, float* out);                                 \
  /* Clips at `limit` and returns how many reached it. */                                          \
  std::size_t clip(float limit, float* values, std::size_t count);                                 \
  /* counts = round(e * dn_per_e + bias) within 0..highest; returns how many reached highest. */   \
  std::size_t digitise(const float* e, std::size_t count, float dn_per_e, float bias_dn,           \
                       float highest_dn, std::uint16_t* counts);                                   \
  }
DMISE_EACH_SIMD_SET(DMISE_DETECTOR_KERNELS)
#undef DMISE_DETECTOR_KERNELS

}  // namespace dmise
