#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/simd_level.h"

namespace dmise {

/// Amplifier and converter.
struct Adc {
  double gain_e_per_dn = 1.0;
  double bias_dn = 0.0;
  int bits = 16;  // 1..16
};

/// counts[i] = electrons[i] / gain + bias, rounded half up, within 0 and 2^bits - 1. Returns how
/// many reached the upper limit.
std::size_t quantise(const Adc& adc, std::span<const float> electrons, std::uint16_t* counts,
                     SimdLevel level);

}  // namespace dmise
