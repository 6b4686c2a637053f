#include "core/detection/beamlet_kernels.h"

#include "core/base/lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

using I16 = std::int16_t __attribute__((vector_size(DMISE_SIMD_BYTES)));
constexpr std::size_t step = DMISE_SIMD_BYTES / 2;

DMISE_INLINE std::int16_t largest(I16 v) {
  std::int16_t most = v[0];
  for (std::size_t i = 1; i < step; ++i) most = v[i] > most ? v[i] : most;
  return most;
}

/// Visits all x: `whole(x)` where both sums lie inside, by vectors; `part(x)` elsewhere.
template <class Whole, class Part>
DMISE_INLINE void for_columns(std::size_t shift, std::size_t width, Whole&& whole, Part&& part) {
  std::size_t x = 0;
  for (; x + shift + 1 + step <= width; x += step) whole(x);
  for (; x < width; ++x) part(x);
}

}  // namespace

void join_beamlets(std::int16_t* a, std::int16_t* b, std::size_t shift, std::size_t width,
                   std::int16_t most[2]) {
  I16 most0 = I16{} + std::int16_t(-32768), most1 = most0;
  std::int16_t rest0 = -32768, rest1 = -32768;
  for_columns(
      shift, width,
      [&](std::size_t x) {
        const I16 first = load<I16>(a + x);
        const I16 sum0 = first + load<I16>(b + x + shift);
        const I16 sum1 = first + load<I16>(b + x + shift + 1);
        store(a + x, sum0);
        store(b + x, sum1);
        most0 = sum0 > most0 ? sum0 : most0;
        most1 = sum1 > most1 ? sum1 : most1;
      },
      [&](std::size_t x) {
        const std::int16_t first = a[x];
        const auto sum0 = std::int16_t(x + shift < width ? first + b[x + shift] : first);
        const auto sum1 = std::int16_t(x + shift + 1 < width ? first + b[x + shift + 1] : first);
        a[x] = sum0;
        b[x] = sum1;
        rest0 = sum0 > rest0 ? sum0 : rest0;
        rest1 = sum1 > rest1 ? sum1 : rest1;
      });
  const std::int16_t whole0 = largest(most0), whole1 = largest(most1);
  most[0] = whole0 > rest0 ? whole0 : rest0;
  most[1] = whole1 > rest1 ? whole1 : rest1;
}

}  // namespace dmise::DMISE_SIMD
