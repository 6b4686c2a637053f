#include "core/base/numeric/vector_math_kernels.h"

#include "core/base/numeric/lane_functions.h"

namespace dmise::DMISE_SIMD {
namespace {

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
      x, count, out, [](F64 v) __attribute__((always_inline)) {
        return exp_of_lanes(max(min(v, splat(700.0)), splat(-700.0)));
      });
}

void log1p_of(const double* x, std::size_t count, double* out) {
  for_lanes(
      x, count, out, [](F64 v) __attribute__((always_inline)) { return log1p_lanes(v); });
}

}  // namespace dmise::DMISE_SIMD
