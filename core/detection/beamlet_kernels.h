#pragma once
#include <cstddef>
#include <cstdint>

namespace dmise {

#define DMISE_BEAMLET_KERNELS(level)                                                           \
  namespace level {                                                                            \
  /* Replaces rows a and b of `width` sums by a[x] + b[x + shift] and a[x] + b[x + shift + 1], \
     zero beyond the end; `most` gets the largest of each. shift >= 0. */                      \
  void join_beamlets(std::int16_t* a, std::int16_t* b, std::size_t shift, std::size_t width,   \
                     std::int16_t most[2]);                                                    \
  }
DMISE_BEAMLET_KERNELS(sse2)
DMISE_BEAMLET_KERNELS(avx2)
DMISE_BEAMLET_KERNELS(avx512)
#undef DMISE_BEAMLET_KERNELS

}  // namespace dmise
