#pragma once
#include "core/base/numeric/lanes.h"

// Elementary functions of lanes, by additions and multiplications in a fixed order.
namespace dmise::DMISE_SIMD {

/// e^x for x in [-700, 700], relative error below 4e-16, by Taylor's series about the nearest
/// multiple of ln 2.
DMISE_INLINE F64 exp_of_lanes(F64 x) {
  constexpr double magic = 0x1.8p52;  // adding it leaves the nearest integer in the low bits
  const F64 shifted = x * 1.4426950408889634 + magic;
  const F64 n = shifted - magic;
  const F64 r = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;
  F64 p = polynomial(r, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320,
                     1.0 / 5040, 1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5);
  p = p * (r * r) + r + 1.0;
  const I64 scale = ((bits<I64>(shifted) + 1023) & 0x7ff) << 52;  // 2^n
  return p * bits<F64>(scale);
}

}  // namespace dmise::DMISE_SIMD
