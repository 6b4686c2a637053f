#pragma once
#include <cstddef>
#include <cstdint>

namespace dmise {

/// Of a turn of 2^32, the golden section: any run of pixels has evenly spread values.
inline constexpr std::uint32_t dither_per_pixel = 0x9E3779B9u;

#define DMISE_FILTER_KERNELS(level)                                                              \
  namespace level {                                                                              \
  /* out[x] = the step (FilteredFrame) of value[x] / (unit * noise[x]); `odd`: whether the first \
     pixel's column plus row is. */                                                              \
  void steps_of(const float* value, const float* noise, float unit, std::size_t count, bool odd, \
                std::int8_t* out);                                                              \
  /* Subtracts middle[0] + x middle[1] from the steps that are not 0 and multiplies what is left \
     by scale[0] + x scale[1]. What was whole steps would round back to the same: so as to be    \
     right on average they are dithered by `dither` + x dither_per_pixel [2^-32 steps]. */       \
  void flatten_steps(std::int8_t* steps, std::size_t count, bool odd, std::uint32_t dither,     \
                     const float middle[2], const float scale[2]);                               \
  }
DMISE_FILTER_KERNELS(sse2)
DMISE_FILTER_KERNELS(avx2)
DMISE_FILTER_KERNELS(avx512)
#undef DMISE_FILTER_KERNELS

}  // namespace dmise
