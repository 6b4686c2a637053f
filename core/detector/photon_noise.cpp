#include "core/detector/photon_noise.h"

#include "core/detector/poisson.h"

namespace dmise {

void photon_noise(const RngKey& key, std::uint32_t first, std::span<float> electrons,
                  SimdLevel level) {
  poisson(key, first, electrons.data(), electrons.size(), electrons.data(), level);
}

}  // namespace dmise
