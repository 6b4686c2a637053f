#include "core/detector/full_well.h"

#include "core/detector/detector_kernels.h"

namespace dmise {

std::size_t full_well(double full_well_e, std::span<float> electrons, SimdLevel level) {
  const auto kernel = kernel_of(level, sse2::clip, avx2::clip, avx512::clip);
  return kernel(float(full_well_e), electrons.data(), electrons.size());
}

}  // namespace dmise
