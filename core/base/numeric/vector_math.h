#pragma once
#include <span>

#include "core/base/numeric/simd_level.h"

// Elementary functions of many numbers by additions, multiplications and divisions in a fixed
// order: the same bytes on every processor, which the C library does not promise.
namespace dmise {

/// out[i] = e^x[i], relative error below 4e-16; `x` is clamped to -700..700. Both spans have one
/// size and may be the same.
void exp_of(std::span<const double> x, std::span<double> out, SimdLevel level = best_simd_level());

/// out[i] = ln(1 + x[i]) for x in [0, 1], relative error below 1e-15.
void log1p_of(std::span<const double> x, std::span<double> out,
              SimdLevel level = best_simd_level());

}  // namespace dmise
