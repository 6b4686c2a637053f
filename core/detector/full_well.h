#pragma once
#include <cstddef>
#include <span>

#include "core/base/simd_level.h"

namespace dmise {

/// Clips at the full well; returns how many pixels reached it.
std::size_t full_well(double full_well_e, std::span<float> electrons, SimdLevel level);

}  // namespace dmise
