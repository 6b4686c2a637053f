#pragma once
#include "core/base/numeric/lanes.h"
#include "core/base/numeric/rng.h"

// core/base/numeric/rng.h for several pixels at a time.
namespace dmise::DMISE_SIMD {

/// Philox4x32-10 on several vectors of blocks at a time, to hide the latency of its
/// multiplications. Counters are in the low halves; high halves are undefined afterwards.
template <int Abreast>
DMISE_INLINE void philox_rounds(const RngKey& key, U64 (&c0)[Abreast], U64 (&c1)[Abreast],
                                U64 (&c2)[Abreast], U64 (&c3)[Abreast]) {
  const U64 zero{};
  std::uint32_t k0 = key.key[0], k1 = key.key[1];
  for (int round = 0; round < 10; ++round) {
    for (int j = 0; j < Abreast; ++j) {
      const U64 p0 = multiply_low(c0[j], zero + 0xD2511F53u);
      const U64 p1 = multiply_low(c2[j], zero + 0xCD9E8D57u);
      // `multiply_low` ignores the high halves.
      c0[j] = (p1 >> 32) ^ c1[j] ^ (zero + k0);
      c1[j] = p1;
      c2[j] = (p0 >> 32) ^ c3[j] ^ (zero + k1);
      c3[j] = p0;
    }
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
}

/// Words of `Pixels` consecutive pixels from `first` on, a multiple of rng_group.
template <int Pixels>
DMISE_INLINE void words_of(const RngKey& key, std::uint32_t first, std::uint32_t draw,
                           std::uint32_t* words) {
  static_assert(Pixels % int(rng_group) == 0);
  constexpr int vectors = Pixels / 4 / wide_lanes;
  constexpr int abreast = vectors < 4 ? vectors : 4;
  const U64 zero{}, low = zero + 0xffffffffu;
  U64 lane;
  for (int i = 0; i < wide_lanes; ++i) lane[i] = std::uint32_t(i);
  for (int v = 0; v < vectors; v += abreast) {
    U64 c0[abreast], c1[abreast], c2[abreast], c3[abreast];
    for (int j = 0; j < abreast; ++j) {
      c0[j] = lane + (first / 4 + std::uint32_t((v + j) * wide_lanes));
      c1[j] = zero + draw;
      c2[j] = zero + key.stream[0];
      c3[j] = zero + key.stream[1];
    }
    philox_rounds<abreast>(key, c0, c1, c2, c3);
    for (int j = 0; j < abreast; ++j) {
      const int block = (v + j) * wide_lanes;
      std::uint32_t* group = words + block / 8 * int(rng_group) + block % 8 * 2;
      store(group, (c0[j] & low) | (c1[j] << 32));
      store(group + 16, (c2[j] & low) | (c3[j] << 32));
    }
  }
}

/// Words of any `pixels_abreast` pixels.
inline constexpr int pixels_abreast = 4 * wide_lanes;
DMISE_INLINE void words_at(const RngKey& key, const std::uint32_t* pixels, std::uint32_t draw,
                           std::uint32_t* words) {
  constexpr int abreast = pixels_abreast / wide_lanes;
  const U64 zero{}, low = zero + 0xffffffffu;
  U64 pixel[abreast], c0[abreast], c1[abreast], c2[abreast], c3[abreast];
  for (int j = 0; j < abreast; ++j) {
    for (int i = 0; i < wide_lanes; ++i) pixel[j][i] = pixels[j * wide_lanes + i];
    c0[j] = (pixel[j] >> 5 << 3) + ((pixel[j] & 15) >> 1);
    c1[j] = zero + draw;
    c2[j] = zero + key.stream[0];
    c3[j] = zero + key.stream[1];
  }
  philox_rounds<abreast>(key, c0, c1, c2, c3);
  for (int j = 0; j < abreast; ++j) {
    const U64 upper = zero - (pixel[j] >> 4 & 1), odd = zero - (pixel[j] & 1);
    const U64 even_word = (c0[j] & ~upper) | (c2[j] & upper);
    const U64 odd_word = (c1[j] & ~upper) | (c3[j] & upper);
    const U64 word = ((even_word & ~odd) | (odd_word & odd)) & low;
    for (int i = 0; i < wide_lanes; ++i) words[j * wide_lanes + i] = std::uint32_t(word[i]);
  }
}

/// Natural logarithm of q in (0, 1], absolute error below 1e-7 (1 + |ln q|).
DMISE_INLINE F32 log_of(F32 q) {
  const I32 shifted = bits<I32>(q) - 0x3f3504f3;  // sqrt(1/2), so mantissas in [sqrt 1/2, sqrt 2)
  const I32 exponent = shifted >> 23;
  const F32 f = bits<F32>((shifted & 0x7fffff) + 0x3f3504f3) - 1.0f;
  F32 p = polynomial(f, -0.083054870f, 0.127989404f, -0.129434034f, 0.141902319f, -0.166434891f,
                     0.200018801f, -0.250002809f, 0.333333265f);
  return to_f32(exponent) * 0.693147181f + (f - f * f * (0.5f - f * p));
}

/// Standard normal quantile of words. With p the nearer tail's probability and w = -ln 4p(1-p):
/// z = (1 - 2p) P(w), P fitted in two pieces to 6e-8 of its value.
DMISE_INLINE F32 normal_of_words(U32 word) {
  const I32 negative = bits<I32>(word) < 0 ? I32{} : I32{} - 1;  // word < 2^31: below the median
  const I32 m = bits<I32>(negative ? word : ~word);              // [0, 2^31)
  const F32 p = (to_f32(m) + 0.5f) * 0x1p-32f;
  const F32 d = (to_f32(0x7fffffff - m) + 0.5f) * 0x1p-31f;  // 1 - 2 p
  const F32 w = -log_of(4.0f * p * (1.0f - p));
  const F32 t = w * (1.0f / 3.0f) - 1.0f;
  F32 z = polynomial(t, -0.000162193363f, -4.02223283e-05f, 0.00140906236f, -0.00194370611f,
                     -0.00438406914f, 0.0223920671f, -0.0319243592f, -0.0730402069f, 1.02515065f,
                     2.29603523f);
  const I32 tail = w > 6.0f;
  if (any(tail)) {
    const F32 s = (sqrt(max(w, splat(6.0f))) - 3.54853488f) * 0.909880738f;
    F32 y = polynomial(s, 8.37839297e-05f, -0.000517000723f, 0.00105393792f, -0.00131495375f,
                       0.00187578879f, -0.00349236043f, 0.00512034305f, 1.56620949f, 4.78624393f);
    z = tail ? y : z;
  }
  z = z * d;
  return negative ? -z : z;
}

}  // namespace dmise::DMISE_SIMD
