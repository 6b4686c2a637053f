#pragma once
#include <cstddef>
#include <cstdint>

#include "core/base/numeric/simd_sets.h"

namespace dmise {

/// Rows of a sum have whole numbers of as many pixels.
inline constexpr std::size_t stack_lanes = 16;

/// One row of each frame, where a rate puts it.
struct StackRows {
  const float* const* light = nullptr;    // weight times SNR
  const float* const* weight2 = nullptr;  // squares of the weights
  std::size_t frames = 0;
};

/// Greatest square of the SNR at each pixel of a row, and the rate with it.
struct StackBest {
  float* snr2 = nullptr;
  std::uint32_t* rate = nullptr;
};

#define DMISE_STACK_KERNELS(level)                                                          \
  namespace level {                                                                         \
  /* Adds the frames' rows and takes the sums that are greater than the best, of `rate`. */ \
  void stack_rows(const StackRows& rows, std::size_t columns, std::uint32_t rate,           \
                  const StackBest& best);                                                   \
  }
DMISE_EACH_SIMD_SET(DMISE_STACK_KERNELS)
#undef DMISE_STACK_KERNELS

}  // namespace dmise
