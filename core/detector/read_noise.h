#pragma once
#include <cstdint>
#include <span>

#include "core/base/rng.h"

namespace dmise {

/// Adds a normal deviate of standard deviation `read_noise_e` to every pixel; `first` is a multiple
/// of rng_group.
void read_noise(double read_noise_e, const RngKey& key, std::uint32_t first,
                std::span<float> electrons, SimdLevel level);

}  // namespace dmise
