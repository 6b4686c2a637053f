#include "core/detection/source/beamlet_kernels.h"

#include "core/base/numeric/lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

using I16 = std::int16_t __attribute__((vector_size(DMISE_SIMD_BYTES)));
constexpr std::size_t step = DMISE_SIMD_BYTES / 2;
static_assert(step <= beamlet_spare);

DMISE_INLINE I16 max(I16 a, I16 b) { return a > b ? a : b; }
DMISE_INLINE I16 splat(std::int16_t x) { return I16{} + x; }

#if defined(__AVX512F__)
DMISE_INLINE bool any_at_least(I16 v, I16 least) {
  return _mm512_cmpge_epi16_mask((__m512i)v, (__m512i)least) != 0;
}
#elif defined(__AVX2__)
DMISE_INLINE bool any_at_least(I16 v, I16 least) {
  return _mm256_movemask_epi8((__m256i)(v >= least)) != 0;
}
#else
DMISE_INLINE bool any_at_least(I16 v, I16 least) { return any((I32)(v >= least)); }
#endif

/// Adds what is large enough of rows of sums that begin at `columns`.
template <std::size_t rows>
__attribute__((noinline)) void add_hits(const I16 (&sums)[rows],
                                        const std::uint32_t (&columns)[rows],
                                        const std::int16_t (&least)[rows], BeamletHit* to,
                                        std::size_t& count) {
  for (std::size_t i = 0; i < step; ++i)
    for (std::size_t r = 0; r < rows; ++r)
      if (sums[r][i] >= least[r])
        to[count++] = {columns[r] + std::uint32_t(i), std::int16_t(r), sums[r][i]};
}

}  // namespace

void widen_steps(const std::int8_t* from, std::size_t count, bool reversed, std::int16_t* to) {
  if (reversed)
    for (std::size_t i = 0; i < count; ++i) to[i] = from[count - 1 - i];
  else
    for (std::size_t i = 0; i < count; ++i) to[i] = from[i];
}

void join_two(std::int16_t* const rows[2], std::size_t shift, std::size_t begin, std::size_t end,
              const BeamletLeast& least, BeamletHits& hits) {
  std::int16_t *a = rows[0], *b = rows[1];
  const std::int16_t of_sums[2] = {least.whole[0], least.whole[1]};
  const I16 lower = splat(of_sums[0] < of_sums[1] ? of_sums[0] : of_sums[1]);
  for (std::size_t x = begin; x < end; x += step) {
    const I16 first = load<I16>(a + x);
    const I16 sums[2] = {first + load<I16>(b + x + shift), first + load<I16>(b + x + shift + 1)};
    store(a + x, sums[0]);
    store(b + x, sums[1]);
    if (any_at_least(max(sums[0], sums[1]), lower)) [[unlikely]] {
      const auto column = std::uint32_t(x);
      add_hits<2>(sums, {column, column}, of_sums, hits.whole, hits.in_whole);
    }
  }
}

void join_four(std::int16_t* const rows[4], std::size_t shift, std::size_t begin, std::size_t end,
               const BeamletLeast& least, BeamletHits& hits) {
  std::int16_t *a = rows[0], *b = rows[1], *c = rows[2], *d = rows[3];
  const std::int16_t(&of_whole)[4] = least.whole;
  const std::int16_t of_halves[4] = {least.halves[0], least.halves[1], least.halves[0],
                                     least.halves[1]};
  std::int16_t low_whole = of_whole[0];
  for (int r = 1; r < 4; ++r) low_whole = of_whole[r] < low_whole ? of_whole[r] : low_whole;
  const I16 lower = splat(low_whole);
  const I16 lower_half = splat(of_halves[0] < of_halves[1] ? of_halves[0] : of_halves[1]);
  const auto two = std::uint32_t(2 * shift);
  const bool keeps_sums = least.keeps_sums;
  for (std::size_t x = begin; x < end; x += step) {
    const std::int16_t *to_b = b + x + shift, *to_c = c + x + 2 * shift, *to_d = d + x + 3 * shift;
    const I16 first = load<I16>(a + x), middle = load<I16>(to_c + 1);
    // Sums over the upper half, and over the lower one where the four need it.
    const I16 upper0 = first + load<I16>(to_b), upper1 = first + load<I16>(to_b + 1);
    const I16 lower0 = load<I16>(to_c) + load<I16>(to_d);
    const I16 lower0_next = middle + load<I16>(to_d + 1);
    const I16 lower1 = middle + load<I16>(to_d + 2);
    const I16 lower1_next = load<I16>(to_c + 2) + load<I16>(to_d + 3);
    const I16 sums[4] = {upper0 + lower0, upper0 + lower0_next, upper1 + lower1,
                         upper1 + lower1_next};
    if (keeps_sums) {
      store(a + x, sums[0]);
      store(b + x, sums[1]);
      store(c + x, sums[2]);
      store(d + x, sums[3]);
    }
    const I16 most = max(max(sums[0], sums[1]), max(sums[2], sums[3]));
    const I16 max_half = max(max(upper0, upper1), max(lower0, lower1));
    const auto column = std::uint32_t(x);
    if (any_at_least(max_half, lower_half)) [[unlikely]] {
      const I16 halves[4] = {upper0, upper1, lower0, lower1};
      add_hits<4>(halves, {column, column, column + two, column + two + 1}, of_halves, hits.halves,
                  hits.in_halves);
    }
    if (any_at_least(most, lower)) [[unlikely]]
      add_hits<4>(sums, {column, column, column, column}, of_whole, hits.whole, hits.in_whole);
  }
}

}  // namespace dmise::DMISE_SIMD
