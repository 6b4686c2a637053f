#pragma once
#include <cstddef>
#include <cstdint>

namespace dmise {

#define DMISE_FILTER_KERNELS(level)                                                              \
  namespace level {                                                                              \
  /* out[x] = the step (FilteredFrame) of value[x] / (unit * noise[x]); `odd`: whether the first \
     pixel's column plus row is. */                                                              \
  void steps_of(const float* value, const float* noise, float unit, std::size_t count, bool odd, \
                std::int16_t* out);                                                              \
  /* Subtracts middle[0] + x middle[1] from the steps that are not 0 and multiplies what is left \
     by scale[0] + x scale[1]. */                                                                \
  void flatten_steps(std::int16_t* steps, std::size_t count, bool odd, const float middle[2],    \
                     const float scale[2]);                                                      \
  }
DMISE_FILTER_KERNELS(sse2)
DMISE_FILTER_KERNELS(avx2)
DMISE_FILTER_KERNELS(avx512)
#undef DMISE_FILTER_KERNELS

}  // namespace dmise
