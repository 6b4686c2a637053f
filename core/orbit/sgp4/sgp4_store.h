// Stores the lanes of a block to the caller's arrays. Groups take their objects in catalogue order,
// so neighbouring lanes often have neighbouring destinations. Included only by sgp4_kernel.h.
#pragma once
#include "core/orbit/sgp4/sgp4_kernels.h"
#include "core/orbit/sgp4/sgp4_pack.h"

namespace dmise::sgp4 {
namespace {

/// x, y, z of position and velocity of the lanes of one vector.
struct Six {
  One value[6];
};

/// Destinations of one vector's lanes, `index` ascending.
struct Places {
  const std::uint32_t* index;
  unsigned count;  // lanes that hold an object: the first ones
  bool whole;      // all lanes, neighbours
#if defined(__AVX512F__)
  // All within 16 from the first: two compressed stores, one per half.
  bool close;
  __mmask8 low, high;
  __m512i from_low, from_high;
#endif
};

DMISE_INLINE Places places_of(const std::uint32_t* index, std::size_t objects) {
  Places p;
  p.index = index;
  p.count = objects < one_lanes ? unsigned(objects) : unsigned(one_lanes);
  const unsigned span = p.count ? index[p.count - 1] - index[0] : ~0u;
  p.whole = p.count == one_lanes && span == one_lanes - 1;
#if defined(__AVX512F__)
  p.close = span < 2 * one_lanes;
  if (p.close && !p.whole) {
    const __mmask16 lanes = __mmask16((1u << p.count) - 1u);
    const __m512i offset =
        _mm512_sub_epi32(_mm512_maskz_loadu_epi32(lanes, index), _mm512_set1_epi32(int(index[0])));
    const unsigned taken = unsigned(
        _mm512_reduce_or_epi32(_mm512_maskz_sllv_epi32(lanes, _mm512_set1_epi32(1), offset)));
    p.low = __mmask8(taken), p.high = __mmask8(taken >> one_lanes);
    const __m512i lane = _mm512_set_epi64(7, 6, 5, 4, 3, 2, 1, 0);
    p.from_low = _mm512_maskz_expand_epi64(p.low, lane);
    p.from_high = _mm512_maskz_expand_epi64(
        p.high, _mm512_add_epi64(lane, _mm512_set1_epi64(__builtin_popcount(p.low))));
  }
#endif
  return p;
}

/// Stores runs of neighbours together.
DMISE_INLINE void put_runs(const Six& s, const Places& p, const Output& out) {
  for (unsigned lane = 0, next; lane < p.count; lane = next) {
    const std::uint32_t to = p.index[lane] - lane;  // lane 0's; elements before it are kept
    for (next = lane + 1; next < p.count && p.index[next] - next == to; ++next) {
    }
    const unsigned run = (1u << next) - (1u << lane);
    const auto i = std::ptrdiff_t(std::int32_t(to));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      store_some(out.position + i + axis * out.stride, s.value[axis], run);
      store_some(out.velocity + i + axis * out.stride, s.value[3 + axis], run);
    }
  }
}

DMISE_INLINE void put(const Six& s, const Places& p, const Output& out) {
  if (p.whole) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      store_anywhere(out.position + p.index[0] + axis * out.stride, s.value[axis]);
      store_anywhere(out.velocity + p.index[0] + axis * out.stride, s.value[3 + axis]);
    }
    return;
  }
#if defined(__AVX512F__)
  if (p.close) {
    const auto place = [&](double* to, One v) __attribute__((always_inline)) {
      _mm512_mask_storeu_pd(to, p.low, _mm512_permutexvar_pd(p.from_low, v.v));
      _mm512_mask_storeu_pd(to + one_lanes, p.high, _mm512_permutexvar_pd(p.from_high, v.v));
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place(out.position + p.index[0] + axis * out.stride, s.value[axis]);
      place(out.velocity + p.index[0] + axis * out.stride, s.value[3 + axis]);
    }
    return;
  }
#endif
  put_runs(s, p, out);
}

}  // namespace
}  // namespace dmise::sgp4
