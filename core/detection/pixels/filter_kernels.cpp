#include "core/detection/pixels/filter_kernels.h"

#include "core/base/numeric/lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

constexpr float most = 31.0f;  // FilteredFrame::most
constexpr float per_sigma = 5.0f;

using Steps = std::int8_t __attribute__((vector_size(lanes)));
using Counts = std::uint16_t __attribute__((vector_size(2 * lanes)));

/// Numbers from 0 on.
DMISE_INLINE I32 numbers() {
  I32 v{};
  for (int i = 0; i < lanes; ++i) v[i] = i;
  return v;
}

/// The nearest step; 0 becomes 1 in columns where `odd` is 1, else -1.
DMISE_INLINE I32 rounded(F32 scaled, I32 odd) {
  scaled = max(min(scaled, splat(most)), splat(-most));
  const F32 half = scaled < 0.0f ? splat(-0.5f) : splat(0.5f);
  const I32 step = to_i32(scaled + half);
  return step != 0 ? step : 2 * odd - 1;
}

/// Visits `count` columns by vectors; the last ones as if by a whole vector, from copies.
template <class Visit>
DMISE_INLINE void for_vectors(std::size_t count, Visit&& visit) {
  std::size_t x = 0;
  for (; x + std::size_t(lanes) <= count; x += std::size_t(lanes)) visit(x, std::size_t(lanes));
  if (x < count) visit(x, count - x);
}
template <class V, class T>
DMISE_INLINE V load_part(const T* p, std::size_t count) {
  V v{};
  __builtin_memcpy(&v, p, count * sizeof(T));
  return v;
}

DMISE_INLINE I32 steps_of(F32 value, F32 noise, float unit, I32 odd) {
  return rounded(value / (unit * noise) * per_sigma, odd);
}

}  // namespace

void weigh_rows(const float* const* before, const float* const* after, const float* weights,
                std::size_t radius, std::size_t count, float* out) {
  std::size_t x = 0;
  for (; x + std::size_t(lanes) <= count; x += std::size_t(lanes)) {
    F32 sum = weights[0] * load<F32>(before[0] + x);
    for (std::size_t i = 1; i <= radius; ++i)
      sum += weights[i] * (load<F32>(before[i] + x) + load<F32>(after[i] + x));
    store(out + x, sum);
  }
  for (; x < count; ++x) {
    float sum = weights[0] * before[0][x];
    for (std::size_t i = 1; i <= radius; ++i) sum += weights[i] * (before[i][x] + after[i][x]);
    out[x] = sum;
  }
}

void above_level(const std::uint16_t* counts, const float* level, std::size_t count, float* out) {
  for (std::size_t x = 0; x < count; ++x) out[x] = float(counts[x]) - level[x];
}

void flat_counts(const std::uint16_t* counts, const float* level, float mean, std::size_t count,
                 std::uint16_t* out) {
  for_vectors(count, [&](std::size_t x, std::size_t n) {
    const bool whole = n == std::size_t(lanes);
    const Counts c = whole ? load<Counts>(counts + x) : load_part<Counts>(counts + x, n);
    const F32 sky = whole ? load<F32>(level + x) : load_part<F32>(level + x, n);
    const F32 flat = to_f32(__builtin_convertvector(c, I32)) - sky + mean + 0.5f;
    const F32 held = max(min(flat, splat(65535.0f)), F32{});
    const Counts rounded = __builtin_convertvector(to_i32(held), Counts);
    if (whole)
      store(out + x, rounded);
    else
      __builtin_memcpy(out + x, &rounded, n * sizeof(std::uint16_t));
  });
}

void between_cells(const float* weights, float first, float rise, std::size_t count, float* out) {
  std::size_t x = 0;
  for (; x + std::size_t(lanes) <= count; x += std::size_t(lanes))
    store(out + x, first + load<F32>(weights + x) * rise);
  for (; x < count; ++x) out[x] = first + weights[x] * rise;
}

double sum_of_values(const float* values, std::size_t count) {
  // Eight lanes on every instruction set, so that the sum has one order.
  constexpr std::size_t lanes_of_sum = 8;
  using Values = float __attribute__((vector_size(lanes_of_sum * sizeof(float))));
  using Sums = double __attribute__((vector_size(lanes_of_sum * sizeof(double))));
  Sums sums{};
  std::size_t i = 0;
  for (; i + lanes_of_sum <= count; i += lanes_of_sum)
    sums += __builtin_convertvector(load<Values>(values + i), Sums);
  double sum = 0.0;
  for (; i < count; ++i) sum += double(values[i]);
  for (std::size_t k = 0; k < lanes_of_sum; ++k) sum += sums[k];
  return sum;
}

void mark_above(const float* value, const float* noise, float bar, std::size_t count,
                std::uint8_t* blocks) {
  for (std::size_t x = 0; x < count; x += filter_block) {
    std::uint8_t above = 0;
    if (x + filter_block <= count) {
      I32 any_above{};
      for (std::size_t i = 0; i < filter_block; i += std::size_t(lanes))
        any_above |= load<F32>(value + x + i) > bar * load<F32>(noise + x + i);
      above = any(any_above);
    } else {
      for (std::size_t i = x; i < count; ++i) above |= value[i] > bar * noise[i];
    }
    blocks[x / filter_block] = above;
  }
}

void steps_of(const float* value, const float* noise, float unit, std::size_t count, bool odd,
              std::int8_t* out) {
  const I32 parity = (numbers() + std::int32_t(odd)) & 1;  // lanes are even
  for_vectors(count, [&](std::size_t x, std::size_t n) {
    const bool whole = n == std::size_t(lanes);
    const F32 v = whole ? load<F32>(value + x) : load_part<F32>(value + x, n);
    const F32 s = whole ? load<F32>(noise + x) : load_part<F32>(noise + x, n);
    const Steps steps = __builtin_convertvector(steps_of(v, s, unit, parity), Steps);
    if (whole)
      store(out + x, steps);
    else
      __builtin_memcpy(out + x, &steps, n);
  });
}

void flatten_steps(std::int8_t* steps, std::size_t count, bool odd, std::uint32_t dither,
                   const float middle[2], const float scale[2]) {
  constexpr float per_turn = 1.0f / 4294967296.0f;
  const I32 parity = (numbers() + std::int32_t(odd)) & 1;
  const U32 turns = bits<U32>(numbers()) * dither_per_pixel + dither;
  for_vectors(count, [&](std::size_t x, std::size_t n) {
    const bool whole = n == std::size_t(lanes);
    const Steps before = whole ? load<Steps>(steps + x) : load_part<Steps>(steps + x, n);
    const F32 at = to_f32(numbers() + std::int32_t(x));
    const I32 turn = bits<I32>(turns + std::uint32_t(x) * dither_per_pixel);
    const I32 wide = __builtin_convertvector(before, I32);
    const F32 flat = (to_f32(wide) - (middle[0] + at * middle[1])) * (scale[0] + at * scale[1]);
    const I32 step = rounded(flat + to_f32(turn) * per_turn, parity);
    const Steps after = __builtin_convertvector(wide == 0 ? I32{} : step, Steps);
    if (whole)
      store(steps + x, after);
    else
      __builtin_memcpy(steps + x, &after, n);
  });
}

}  // namespace dmise::DMISE_SIMD
