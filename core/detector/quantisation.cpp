#include "core/detector/quantisation.h"

#include "core/detector/detector_kernels.h"

namespace dmise {

std::size_t quantise(const Adc& adc, std::span<const float> electrons, std::uint16_t* counts,
                     SimdLevel level) {
  const auto kernel = kernel_of(level, sse2::digitise, avx2::digitise, avx512::digitise);
  const auto highest = float((1 << adc.bits) - 1);
  return kernel(electrons.data(), electrons.size(), float(1.0 / adc.gain_e_per_dn),
                float(adc.bias_dn), highest, counts);
}

}  // namespace dmise
