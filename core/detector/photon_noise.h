#pragma once
#include <cstdint>
#include <span>

#include "core/base/rng.h"

namespace dmise {

/// Replaces expected electrons by Poisson deviates, pixel `first` first. Throws as `poisson` does.
void photon_noise(const RngKey& key, std::uint32_t first, std::span<float> electrons,
                  SimdLevel level);

}  // namespace dmise
