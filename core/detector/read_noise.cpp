#include "core/detector/read_noise.h"

#include "core/detector/detector_kernels.h"

namespace dmise {

void read_noise(double read_noise_e, const RngKey& key, std::uint32_t first,
                std::span<float> electrons, SimdLevel level) {
  const auto kernel = kernel_of(level, sse2::add_normal, avx2::add_normal, avx512::add_normal);
  kernel(key, first, float(read_noise_e), electrons.data(), electrons.size());
}

}  // namespace dmise
