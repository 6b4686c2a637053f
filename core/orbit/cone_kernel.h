// The cone test on packs of objects: included by cone_test_{sse2,avx2,avx512}.cpp alone.
#pragma once
#include "core/orbit/cone_kernels.h"
#include "core/orbit/sgp4_pack.h"

namespace dmise {
namespace {

using namespace sgp4;

/// Row bits of 64 objects, their coordinates aligned to 64 bytes. Inside a cone of less than 90
/// degrees: d . axis > 0 and (d . axis)^2 >= cos^2 d^2, with the axis divided by the cosine. A
/// wider one is what lies not inside the opposite one, the apex left out.
template <bool Wide>
DMISE_INLINE std::uint64_t word(const double* x, const double* y, const double* z,
                                const PreparedCone& c) {
  std::uint64_t bits64 = 0;
  for (int k = 0; k < 64; k += pack_lanes) {
    const Pack dx = load(x + k) - c.apex[0];
    const Pack dy = load(y + k) - c.apex[1];
    const Pack dz = load(z + k) - c.apex[2];
    const Pack along = madd(dz, c.axis[2], madd(dy, c.axis[1], dx * c.axis[0]));
    const Pack d2 = madd(dz, dz, madd(dy, dy, dx * dx));
    Mask inside;
    if constexpr (Wide)
      inside = ~((Pack(0.0) < along) & (d2 < along * along)) & (Pack(0.0) < d2);
    else
      inside = (Pack(0.0) < along) & (d2 <= along * along);
    bits64 |= std::uint64_t(bits(inside) & all_lanes) << k;
  }
  return bits64;
}

void cone_words(const double* x, const double* y, const double* z, std::size_t words,
                const PreparedCone& cone, const std::uint64_t* present, std::uint64_t* inside) {
  if (cone.wide)
    for (std::size_t w = 0; w < words; ++w)
      inside[w] = word<true>(x + 64 * w, y + 64 * w, z + 64 * w, cone) & present[w];
  else
    for (std::size_t w = 0; w < words; ++w)
      inside[w] = word<false>(x + 64 * w, y + 64 * w, z + 64 * w, cone) & present[w];
}

}  // namespace
}  // namespace dmise
