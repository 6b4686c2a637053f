// Vectors of doubles, as wide as the instruction set that this file is compiled for: 8 lanes with
// AVX-512 (F, DQ), 4 with AVX2 and FMA, else 2, by the compiler's portable vectors. Included only
// by sgp4_kernel.h, in one file per instruction set; everything has internal linkage, so that no
// function compiled for one set is linked into code that runs on another.
#pragma once
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <cstdint>

#define DMISE_INLINE __attribute__((always_inline)) inline

namespace dmise::sgp4 {
namespace {

#if defined(__AVX512F__) && defined(__AVX512DQ__)
using Doubles = __m512d;
#elif defined(__AVX2__) && defined(__FMA__)
using Doubles = __m256d;
#else
using Doubles = double __attribute__((vector_size(16)));
#endif

constexpr int one_lanes = sizeof(Doubles) / sizeof(double);

struct One {
  Doubles v;
  One() = default;
  DMISE_INLINE One(Doubles x) : v(x) {}
  DMISE_INLINE One(double x) : v(x - Doubles{}) {}
};
DMISE_INLINE void store_anywhere(double* p, One a) { __builtin_memcpy(p, &a.v, sizeof a.v); }
DMISE_INLINE One operator+(One a, One b) { return a.v + b.v; }
DMISE_INLINE One operator-(One a, One b) { return a.v - b.v; }
DMISE_INLINE One operator*(One a, One b) { return a.v * b.v; }
DMISE_INLINE One operator/(One a, One b) { return a.v / b.v; }

// madd(a, b, c) = a b + c and nmadd(a, b, c) = c - a b: fused on purpose where FMA exists.

#if defined(__AVX512F__) && defined(__AVX512DQ__)

constexpr bool fused = true;

struct OneMask {
  __mmask8 m;
};
DMISE_INLINE OneMask operator&(OneMask a, OneMask b) { return {__mmask8(a.m & b.m)}; }
DMISE_INLINE OneMask operator|(OneMask a, OneMask b) { return {__mmask8(a.m | b.m)}; }
DMISE_INLINE OneMask operator~(OneMask a) { return {__mmask8(~a.m)}; }
DMISE_INLINE unsigned bits(OneMask a) { return a.m; }
DMISE_INLINE void store_bits(std::uint8_t* to, OneMask a) { _store_mask8(to, a.m); }

DMISE_INLINE One load_one(const double* p) { return _mm512_load_pd(p); }
DMISE_INLINE void store(double* p, One a) { _mm512_store_pd(p, a.v); }
/// Stores the lanes of `mask` to an unaligned address.
DMISE_INLINE void store_some(double* p, One a, unsigned mask) {
  _mm512_mask_storeu_pd(p, __mmask8(mask), a.v);
}
DMISE_INLINE One madd(One a, One b, One c) { return _mm512_fmadd_pd(a.v, b.v, c.v); }
DMISE_INLINE One nmadd(One a, One b, One c) { return _mm512_fnmadd_pd(a.v, b.v, c.v); }
DMISE_INLINE One sqrt(One a) { return _mm512_sqrt_pd(a.v); }
DMISE_INLINE One max(One a, One b) { return _mm512_max_pd(a.v, b.v); }
DMISE_INLINE One abs(One a) { return _mm512_abs_pd(a.v); }
DMISE_INLINE OneMask operator<(One a, One b) { return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ)}; }
DMISE_INLINE OneMask operator<=(One a, One b) { return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_LE_OQ)}; }
DMISE_INLINE OneMask operator==(One a, One b) { return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_EQ_OQ)}; }
/// m & (a <= b), m & (a < b)
DMISE_INLINE OneMask and_at_most(OneMask m, One a, One b) {
  return {_mm512_mask_cmp_pd_mask(m.m, a.v, b.v, _CMP_LE_OQ)};
}
DMISE_INLINE OneMask and_less(OneMask m, One a, One b) {
  return {_mm512_mask_cmp_pd_mask(m.m, a.v, b.v, _CMP_LT_OQ)};
}
DMISE_INLINE One select(OneMask m, One yes, One no) {
  return _mm512_mask_blend_pd(m.m, no.v, yes.v);
}
DMISE_INLINE One copy_sign(One magnitude, One sign) {
  const __m512d s = _mm512_set1_pd(-0.0);
  return _mm512_or_pd(_mm512_andnot_pd(s, magnitude.v), _mm512_and_pd(s, sign.v));
}
/// -x where the lowest bit of `odd` is set.
DMISE_INLINE One negate_odd(One x, One odd) {
  return _mm512_castsi512_pd(_mm512_xor_si512(_mm512_castpd_si512(x.v),
                                              _mm512_slli_epi64(_mm512_castpd_si512(odd.v), 63)));
}

#elif defined(__AVX2__) && defined(__FMA__)

constexpr bool fused = true;

struct OneMask {
  __m256d m;
};
DMISE_INLINE OneMask operator&(OneMask a, OneMask b) { return {_mm256_and_pd(a.m, b.m)}; }
DMISE_INLINE OneMask operator|(OneMask a, OneMask b) { return {_mm256_or_pd(a.m, b.m)}; }
DMISE_INLINE OneMask operator~(OneMask a) {
  return {_mm256_xor_pd(a.m, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)))};
}
DMISE_INLINE unsigned bits(OneMask a) { return unsigned(_mm256_movemask_pd(a.m)); }

DMISE_INLINE One load_one(const double* p) { return _mm256_load_pd(p); }
DMISE_INLINE void store(double* p, One a) { _mm256_store_pd(p, a.v); }
DMISE_INLINE void store_some(double* p, One a, unsigned mask) {
  const __m256i lane = _mm256_set_epi64x(8, 4, 2, 1);
  _mm256_maskstore_pd(p, _mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x(mask), lane), lane),
                      a.v);
}
DMISE_INLINE One madd(One a, One b, One c) { return _mm256_fmadd_pd(a.v, b.v, c.v); }
DMISE_INLINE One nmadd(One a, One b, One c) { return _mm256_fnmadd_pd(a.v, b.v, c.v); }
DMISE_INLINE One sqrt(One a) { return _mm256_sqrt_pd(a.v); }
DMISE_INLINE One max(One a, One b) { return _mm256_max_pd(a.v, b.v); }
DMISE_INLINE One abs(One a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a.v); }
DMISE_INLINE OneMask operator<(One a, One b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ)}; }
DMISE_INLINE OneMask operator<=(One a, One b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_LE_OQ)}; }
DMISE_INLINE OneMask operator==(One a, One b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_EQ_OQ)}; }
DMISE_INLINE One select(OneMask m, One yes, One no) { return _mm256_blendv_pd(no.v, yes.v, m.m); }
DMISE_INLINE One copy_sign(One magnitude, One sign) {
  const __m256d s = _mm256_set1_pd(-0.0);
  return _mm256_or_pd(_mm256_andnot_pd(s, magnitude.v), _mm256_and_pd(s, sign.v));
}
DMISE_INLINE One negate_odd(One x, One odd) {
  return _mm256_xor_pd(x.v, _mm256_castsi256_pd(_mm256_slli_epi64(_mm256_castpd_si256(odd.v), 63)));
}

#else

#if defined(__FP_FAST_FMA)  // as on AArch64
constexpr bool fused = true;
#else
constexpr bool fused = false;
#endif

using Words = std::int64_t __attribute__((vector_size(16)));

struct OneMask {
  Words m;  // 0 or -1 a lane
};
DMISE_INLINE OneMask operator&(OneMask a, OneMask b) { return {a.m & b.m}; }
DMISE_INLINE OneMask operator|(OneMask a, OneMask b) { return {a.m | b.m}; }
DMISE_INLINE OneMask operator~(OneMask a) { return {~a.m}; }
DMISE_INLINE unsigned bits(OneMask a) {
#if defined(__x86_64__)
  return unsigned(_mm_movemask_pd((__m128d)a.m));
#else
  return unsigned(a.m[0] & 1) | unsigned(a.m[1] & 2);
#endif
}

DMISE_INLINE One load_one(const double* p) {
  return *reinterpret_cast<const Doubles*>(__builtin_assume_aligned(p, 16));
}
DMISE_INLINE void store(double* p, One a) {
  store_anywhere(static_cast<double*>(__builtin_assume_aligned(p, 16)), a);
}
DMISE_INLINE void store_some(double* p, One a, unsigned mask) {
  if (mask & 1u) p[0] = a.v[0];
  if (mask & 2u) p[1] = a.v[1];
}
DMISE_INLINE One madd(One a, One b, One c) {
  if constexpr (!fused) return a * b + c;
  return Doubles{__builtin_fma(a.v[0], b.v[0], c.v[0]), __builtin_fma(a.v[1], b.v[1], c.v[1])};
}
DMISE_INLINE One nmadd(One a, One b, One c) {
  if constexpr (!fused) return c - a * b;
  return madd(-a.v, b, c);
}
DMISE_INLINE One sqrt(One a) {
#if defined(__x86_64__)
  return Doubles(_mm_sqrt_pd(a.v));
#else
  return Doubles{__builtin_sqrt(a.v[0]), __builtin_sqrt(a.v[1])};
#endif
}
DMISE_INLINE OneMask operator<(One a, One b) { return {Words(a.v < b.v)}; }
DMISE_INLINE OneMask operator<=(One a, One b) { return {Words(a.v <= b.v)}; }
DMISE_INLINE OneMask operator==(One a, One b) { return {Words(a.v == b.v)}; }
DMISE_INLINE One select(OneMask m, One yes, One no) {
  return Doubles((m.m & Words(yes.v)) | (~m.m & Words(no.v)));
}
DMISE_INLINE One max(One a, One b) { return select(b < a, a, b); }
constexpr Words sign_bits = {INT64_MIN, INT64_MIN};
DMISE_INLINE One abs(One a) { return Doubles(Words(a.v) & ~sign_bits); }
DMISE_INLINE One copy_sign(One magnitude, One sign) {
  return Doubles((Words(magnitude.v) & ~sign_bits) | (Words(sign.v) & sign_bits));
}
DMISE_INLINE One negate_odd(One x, One odd) { return Doubles(Words(x.v) ^ (Words(odd.v) << 63)); }

#endif

#if !defined(__AVX512F__)
DMISE_INLINE OneMask and_at_most(OneMask m, One a, One b) { return m & (a <= b); }
DMISE_INLINE OneMask and_less(OneMask m, One a, One b) { return m & (a < b); }
#endif

// Two vectors side by side, to hide the latency of each.
struct Mask {
  OneMask a, b;
};
DMISE_INLINE Mask operator&(Mask x, Mask y) { return {x.a & y.a, x.b & y.b}; }
DMISE_INLINE Mask operator|(Mask x, Mask y) { return {x.a | y.a, x.b | y.b}; }
DMISE_INLINE Mask operator~(Mask x) { return {~x.a, ~x.b}; }
DMISE_INLINE unsigned bits(Mask x) { return bits(x.a) | bits(x.b) << one_lanes; }
DMISE_INLINE bool any(Mask x) { return bits(x.a | x.b) != 0; }

constexpr int pack_lanes = 2 * one_lanes;
constexpr unsigned all_lanes = (1u << pack_lanes) - 1u;

struct Pack {
  One a, b;
  Pack() = default;
  DMISE_INLINE Pack(One x, One y) : a(x), b(y) {}
  DMISE_INLINE Pack(double x) : a(x), b(x) {}
};
DMISE_INLINE Pack load(const double* p) { return {load_one(p), load_one(p + one_lanes)}; }
DMISE_INLINE void store(double* p, Pack x) { store(p, x.a), store(p + one_lanes, x.b); }
DMISE_INLINE Pack operator+(Pack x, Pack y) { return {x.a + y.a, x.b + y.b}; }
DMISE_INLINE Pack operator-(Pack x, Pack y) { return {x.a - y.a, x.b - y.b}; }
DMISE_INLINE Pack operator*(Pack x, Pack y) { return {x.a * y.a, x.b * y.b}; }
DMISE_INLINE Pack operator/(Pack x, Pack y) { return {x.a / y.a, x.b / y.b}; }
DMISE_INLINE Pack madd(Pack x, Pack y, Pack z) {
  return {madd(x.a, y.a, z.a), madd(x.b, y.b, z.b)};
}
DMISE_INLINE Pack nmadd(Pack x, Pack y, Pack z) {
  return {nmadd(x.a, y.a, z.a), nmadd(x.b, y.b, z.b)};
}
DMISE_INLINE Pack sqrt(Pack x) { return {sqrt(x.a), sqrt(x.b)}; }
DMISE_INLINE Pack max(Pack x, Pack y) { return {max(x.a, y.a), max(x.b, y.b)}; }
DMISE_INLINE Pack abs(Pack x) { return {abs(x.a), abs(x.b)}; }
DMISE_INLINE Mask operator<(Pack x, Pack y) { return {x.a < y.a, x.b < y.b}; }
DMISE_INLINE Mask operator<=(Pack x, Pack y) { return {x.a <= y.a, x.b <= y.b}; }
DMISE_INLINE Mask operator==(Pack x, Pack y) { return {x.a == y.a, x.b == y.b}; }
DMISE_INLINE Mask and_at_most(Mask m, Pack x, Pack y) {
  return {and_at_most(m.a, x.a, y.a), and_at_most(m.b, x.b, y.b)};
}
DMISE_INLINE Mask and_less(Mask m, Pack x, Pack y) {
  return {and_less(m.a, x.a, y.a), and_less(m.b, x.b, y.b)};
}
DMISE_INLINE Pack select(Mask m, Pack yes, Pack no) {
  return {select(m.a, yes.a, no.a), select(m.b, yes.b, no.b)};
}
DMISE_INLINE Pack copy_sign(Pack x, Pack sign) {
  return {copy_sign(x.a, sign.a), copy_sign(x.b, sign.b)};
}
DMISE_INLINE Pack negate_odd(Pack x, Pack odd) {
  return {negate_odd(x.a, odd.a), negate_odd(x.b, odd.b)};
}

}  // namespace
}  // namespace dmise::sgp4
