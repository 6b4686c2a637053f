// The cone test on packs of objects: included by cone_test_SET.cpp alone.
#pragma once
#include "core/orbit/cones/cone_kernels.h"
#include "core/orbit/sgp4/sgp4_pack.h"

namespace dmise {
namespace {

using namespace sgp4;

/// Inside a cone of less than 90 degrees: d . axis > 0 and (d . axis)^2 >= cos^2 d^2, with the axis
/// divided by the cosine. A wider cone is the complement of the opposite one, without the apex.
template <bool Wide>
DMISE_INLINE Mask in_cone(Pack x, Pack y, Pack z, const PreparedCone& c) {
  const Pack dx = x - c.apex[0];
  const Pack dy = y - c.apex[1];
  const Pack dz = z - c.apex[2];
  const Pack along = madd(dz, c.axis[2], madd(dy, c.axis[1], dx * c.axis[0]));
  const Pack d2 = madd(dz, dz, madd(dy, dy, dx * dx));
  const Mask ahead = Pack(0.0) < along;
  if constexpr (Wide) return and_less(~and_less(ahead, d2, along * along), 0.0, d2);
  return and_at_most(ahead, d2, along * along);
}

template <bool Wide>
void words_of(const double* x, const double* y, const double* z, std::size_t words,
              const PreparedCone& cone, std::uint64_t* inside) {
  for (std::size_t w = 0; w < words; ++w) {
    [[maybe_unused]] auto* bytes = reinterpret_cast<std::uint8_t*>(inside + w);
    std::uint64_t bits64 = 0;
    for (std::size_t k = 0; k < 64; k += pack_lanes) {
      const std::size_t i = 64 * w + k;
      const Mask in = in_cone<Wide>(load(x + i), load(y + i), load(z + i), cone);
#if defined(__AVX512F__)
      // Overlaps the store with the arithmetic.
      store_bits(bytes + k / 8, in.a), store_bits(bytes + k / 8 + 1, in.b);
#else
      bits64 |= std::uint64_t(bits(in) & all_lanes) << k;
#endif
    }
    if constexpr (one_lanes < 8) inside[w] = bits64;
  }
}

/// Bits of the objects that are not at the origin.
void present_words(const double* x, const double* y, const double* z, std::size_t words,
                   std::uint64_t* present) {
  for (std::size_t w = 0; w < words; ++w) {
    std::uint64_t nowhere = 0;
    for (std::size_t k = 0; k < 64; k += pack_lanes) {
      const std::size_t i = 64 * w + k;
      const Mask zero = (load(x + i) == 0.0) & (load(y + i) == 0.0) & (load(z + i) == 0.0);
      nowhere |= std::uint64_t(bits(zero) & all_lanes) << k;
    }
    present[w] = ~nowhere;
  }
}

void cone_words(const double* x, const double* y, const double* z, std::size_t words,
                const PreparedCone& cone, const std::uint64_t* present, std::uint64_t* inside) {
  if (cone.wide)
    words_of<true>(x, y, z, words, cone, inside);
  else
    words_of<false>(x, y, z, words, cone, inside);
  for (std::size_t w = 0; w < words; ++w) inside[w] &= present[w];
}

}  // namespace
}  // namespace dmise
