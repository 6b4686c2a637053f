#pragma once
#include "core/base/numeric/lane_functions.h"
#include "core/base/numeric/random_lanes.h"
#include "core/detector/noise/poisson.h"

// Vectorised core/detector/noise/poisson.h.
namespace dmise::DMISE_SIMD {

using F32Half = float __attribute__((vector_size(DMISE_SIMD_BYTES / 2)));
using U32Half = std::uint32_t __attribute__((vector_size(DMISE_SIMD_BYTES / 2)));

/// Uniform in (0, 1) of 52 bits.
DMISE_INLINE F64 uniform_of(U64 high, U64 low) {
  const U64 mantissa = (high << 20) | (low >> 12);
  return (bits<F64>(mantissa | 0x3ff0000000000000u) - 1.0) + 0x1p-53;
}

/// 1 / i, for the recurrence of the probabilities.
struct Reciprocals {
  double of[poisson_most_steps + 1];
  constexpr Reciprocals() : of{} {
    for (int i = 1; i <= poisson_most_steps; ++i) of[i] = 1.0 / i;
  }
};
inline constexpr Reciprocals reciprocals;

/// Number of k with u > P(N <= k), for means below 24 (for others undefined, but it terminates).
DMISE_INLINE F64 poisson_small(F64 mean, F64 u) {
  F64 p = exp_of_lanes(-mean), cumulative = p, k{};
  for (int i = 1; i <= poisson_most_steps; ++i) {
    const I64 above = u > cumulative;
    if (!any(above)) break;
    k = above ? k + 1.0 : k;
    p = p * (mean * reciprocals.of[i]);
    cumulative += p;
  }
  return k;
}

/// By the expansion, for means >= 24.
DMISE_INLINE F32 poisson_large(F32 mean, U32 word) {
  const F32 root = sqrt(mean), y = 1.0f / root;
  const F32 w = normal_of_words(word);
  const F32 s = max(min(w * y, splat(1.3f)), splat(-1.3f));
  F32 b = polynomial(s, -0.00015232487f, 0.000229912266f, -0.000199164306f, 0.000518381453f,
                     -0.00134131721f, 0.00370720588f, -0.0138885284f, 0.166666632f);
  F32 c = polynomial(s, 0.00107286438f, -0.00147687628f, 0.00135159052f, -0.00335762945f,
                     0.00867375154f, -0.0277850070f, 0.333332961f);
  F32 d = polynomial(s, 0.0179676131f, -0.0145740379f, 0.0164811869f, -0.0197157343f);
  const F32 beyond = root * w + (w * w * b + (c + d * (y * y)));
  // Split off the integer part to keep precision: from 2^23 on a float is an integer.
  const F32 whole = mean < 0x1p23f ? floor(min(mean, splat(0x1p23f))) : mean;
  return max(whole + floor((mean - whole) + beyond), F32{});
}

}  // namespace dmise::DMISE_SIMD
