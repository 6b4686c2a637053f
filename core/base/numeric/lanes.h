#pragma once
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <cstdint>

// Vectors of the widest size of the instruction set that the including file is compiled for (see
// simd.cmake), in namespace dmise::DMISE_SIMD. Operators come from GCC's vector extension; masks
// are integers, 0 or -1 a lane. Only operations that IEEE 754 rounds exactly: the lanes of every
// instruction set hold the same bits.
#if defined(__AVX512F__)
#define DMISE_SIMD avx512
#define DMISE_SIMD_BYTES 64
#elif defined(__AVX2__)
#define DMISE_SIMD avx2
#define DMISE_SIMD_BYTES 32
#elif defined(__x86_64__)
#define DMISE_SIMD sse2
#define DMISE_SIMD_BYTES 16
#else
#define DMISE_SIMD generic
#define DMISE_SIMD_BYTES 16
#endif
#define DMISE_INLINE static inline __attribute__((always_inline))

namespace dmise::DMISE_SIMD {

inline constexpr int lanes = DMISE_SIMD_BYTES / 4;       // 32-bit numbers in a vector
inline constexpr int wide_lanes = DMISE_SIMD_BYTES / 8;  // 64-bit numbers in a vector

using F32 = float __attribute__((vector_size(DMISE_SIMD_BYTES)));
using I32 = std::int32_t __attribute__((vector_size(DMISE_SIMD_BYTES)));
using U32 = std::uint32_t __attribute__((vector_size(DMISE_SIMD_BYTES)));
using F64 = double __attribute__((vector_size(DMISE_SIMD_BYTES)));
using I64 = std::int64_t __attribute__((vector_size(DMISE_SIMD_BYTES)));
using U64 = std::uint64_t __attribute__((vector_size(DMISE_SIMD_BYTES)));

template <class V, class T>
DMISE_INLINE V load(const T* p) {
  V v;
  __builtin_memcpy(&v, p, sizeof(V));
  return v;
}
template <class V, class T>
DMISE_INLINE void store(T* p, V v) {
  __builtin_memcpy(p, &v, sizeof(V));
}
template <class To, class From>
DMISE_INLINE To bits(From v) {
  static_assert(sizeof(To) == sizeof(From));
  return reinterpret_cast<To>(v);
}
DMISE_INLINE F32 splat(float x) { return x - F32{}; }
DMISE_INLINE F64 splat(double x) { return x - F64{}; }
DMISE_INLINE F32 to_f32(I32 v) { return __builtin_convertvector(v, F32); }
DMISE_INLINE I32 to_i32(F32 v) { return __builtin_convertvector(v, I32); }  // truncates

/// The polynomial of these coefficients, that of the highest power first, by Horner's scheme.
template <class V, class C, class... Others>
DMISE_INLINE V polynomial(V x, C highest, Others... others) {
  V sum = splat(highest);
  ((sum = sum * x + others), ...);
  return sum;
}

DMISE_INLINE F32 max(F32 a, F32 b) { return a > b ? a : b; }
DMISE_INLINE F32 min(F32 a, F32 b) { return a < b ? a : b; }
DMISE_INLINE F64 max(F64 a, F64 b) { return a > b ? a : b; }
DMISE_INLINE F64 min(F64 a, F64 b) { return a < b ? a : b; }

#if defined(__AVX512F__)
DMISE_INLINE F32 sqrt(F32 v) { return (F32)_mm512_sqrt_ps((__m512)v); }
DMISE_INLINE F64 sqrt(F64 v) { return (F64)_mm512_sqrt_pd((__m512d)v); }
/// Product of the low halves of each 64-bit lane.
DMISE_INLINE U64 multiply_low(U64 a, U64 b) {
  return (U64)_mm512_mul_epu32((__m512i)a, (__m512i)b);
}
DMISE_INLINE bool any(I32 m) { return _mm512_movepi32_mask((__m512i)m) != 0; }
DMISE_INLINE bool any(I64 m) { return _mm512_movepi64_mask((__m512i)m) != 0; }
#elif defined(__AVX2__)
DMISE_INLINE F32 sqrt(F32 v) { return (F32)_mm256_sqrt_ps((__m256)v); }
DMISE_INLINE F64 sqrt(F64 v) { return (F64)_mm256_sqrt_pd((__m256d)v); }
DMISE_INLINE U64 multiply_low(U64 a, U64 b) {
  return (U64)_mm256_mul_epu32((__m256i)a, (__m256i)b);
}
DMISE_INLINE bool any(I32 m) { return _mm256_movemask_epi8((__m256i)m) != 0; }
DMISE_INLINE bool any(I64 m) { return _mm256_movemask_epi8((__m256i)m) != 0; }
#elif defined(__x86_64__)
DMISE_INLINE F32 sqrt(F32 v) { return (F32)_mm_sqrt_ps((__m128)v); }
DMISE_INLINE F64 sqrt(F64 v) { return (F64)_mm_sqrt_pd((__m128d)v); }
DMISE_INLINE U64 multiply_low(U64 a, U64 b) { return (U64)_mm_mul_epu32((__m128i)a, (__m128i)b); }
DMISE_INLINE bool any(I32 m) { return _mm_movemask_epi8((__m128i)m) != 0; }
DMISE_INLINE bool any(I64 m) { return _mm_movemask_epi8((__m128i)m) != 0; }
#else
DMISE_INLINE F32 sqrt(F32 v) {
  for (int i = 0; i < lanes; ++i) v[i] = __builtin_sqrtf(v[i]);
  return v;
}
DMISE_INLINE F64 sqrt(F64 v) {
  for (int i = 0; i < wide_lanes; ++i) v[i] = __builtin_sqrt(v[i]);
  return v;
}
DMISE_INLINE U64 multiply_low(U64 a, U64 b) { return (a & 0xffffffffu) * (b & 0xffffffffu); }
DMISE_INLINE bool any(I64 m) { return (m[0] | m[1]) != 0; }
DMISE_INLINE bool any(I32 m) { return any((I64)m); }
#endif
DMISE_INLINE bool all(I32 m) { return !any(~m); }

/// Largest integer <= v, for |v| < 2^31.
DMISE_INLINE F32 floor(F32 v) {
  const F32 t = to_f32(to_i32(v));
  return t > v ? t - 1.0f : t;
}

}  // namespace dmise::DMISE_SIMD
