#include "core/base/vector_math_kernels.h"

#include "core/base/lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

/// e^x by Taylor's series about the nearest multiple of ln 2.
DMISE_INLINE F64 exp_lanes(F64 x) {
  x = max(min(x, splat(700.0)), splat(-700.0));
  constexpr double magic = 0x1.8p52;  // adding it leaves the nearest integer in the low bits
  const F64 shifted = x * 1.4426950408889634 + magic;
  const F64 n = shifted - magic;
  const F64 r = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;
  F64 p = splat(1.0 / 479001600);
  p = p * r + 1.0 / 39916800;
  p = p * r + 1.0 / 3628800;
  p = p * r + 1.0 / 362880;
  p = p * r + 1.0 / 40320;
  p = p * r + 1.0 / 5040;
  p = p * r + 1.0 / 720;
  p = p * r + 1.0 / 120;
  p = p * r + 1.0 / 24;
  p = p * r + 1.0 / 6;
  p = p * r + 0.5;
  p = p * (r * r) + r + 1.0;
  const I64 scale = ((bits<I64>(shifted) + 1023) & 0x7ff) << 52;  // 2^n
  return p * bits<F64>(scale);
}

/// 2 artanh(x / (2 + x)) by its series, whose terms fall by 9 and more.
DMISE_INLINE F64 log1p_lanes(F64 x) {
  const F64 s = x / (x + 2.0), z = s * s;
  F64 p = splat(1.0 / 31);
  p = p * z + 1.0 / 29;
  p = p * z + 1.0 / 27;
  p = p * z + 1.0 / 25;
  p = p * z + 1.0 / 23;
  p = p * z + 1.0 / 21;
  p = p * z + 1.0 / 19;
  p = p * z + 1.0 / 17;
  p = p * z + 1.0 / 15;
  p = p * z + 1.0 / 13;
  p = p * z + 1.0 / 11;
  p = p * z + 1.0 / 9;
  p = p * z + 1.0 / 7;
  p = p * z + 1.0 / 5;
  p = p * z + 1.0 / 3;
  return (s + s) + (s + s) * (z * p);
}

template <class Function>
DMISE_INLINE void for_lanes(const double* x, std::size_t count, double* out, const Function& of) {
  std::size_t i = 0;
  for (; i + wide_lanes <= count; i += wide_lanes) store(out + i, of(load<F64>(x + i)));
  if (i == count) return;
  F64 last{};
  for (std::size_t j = i; j < count; ++j) last[j - i] = x[j];
  last = of(last);
  for (std::size_t j = i; j < count; ++j) out[j] = last[j - i];
}

}  // namespace

void exp_of(const double* x, std::size_t count, double* out) {
  for_lanes(
      x, count, out, [](F64 v) __attribute__((always_inline)) { return exp_lanes(v); });
}

void log1p_of(const double* x, std::size_t count, double* out) {
  for_lanes(
      x, count, out, [](F64 v) __attribute__((always_inline)) { return log1p_lanes(v); });
}

}  // namespace dmise::DMISE_SIMD
