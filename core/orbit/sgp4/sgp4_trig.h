// Sines and cosines of packs. Polynomials: minimax on the reduced range, fitted for these files in
// 50 digits; `error` is the largest absolute error. Included only by sgp4_kernel.h.
#pragma once
#include "core/orbit/sgp4/sgp4_pack.h"

namespace dmise::sgp4 {
namespace {

struct SinCos {
  Pack sin, cos;
};

// Adding it rounds a double below 2^51 to an integer, whose parity is then its lowest bit.
constexpr double round_magic = 6755399441055744.0;
constexpr double inv_pi = 0.31830988618379067154;

/// x - k pi. Without FMA pi is split so that k times its first two pieces is exact for |k| < 2^20.
DMISE_INLINE Pack minus_k_pi(Pack x, Pack k) {
  if constexpr (fused)
    return nmadd(k, 1.2246467991473532072e-16, nmadd(k, 3.141592653589793116, x));
  return x - k * 3.1415926534682512 - k * 1.2154201012607932e-10 - k * 4.044532497591901e-21;
}

/// `odd` holds the parity of k in its lowest bit.
struct Reduced {
  Pack r, odd;
};
/// x = r + k pi with |r| <= pi/2.
DMISE_INLINE Reduced reduce_pi(Pack x) {
  const Pack shifted = madd(x, inv_pi, round_magic);
  return {minus_k_pi(x, shifted - round_magic), shifted};
}

// Polynomials in t are split into two in t^2, which halves the dependency chain.

/// error 1.1e-16 and 3.0e-15.
DMISE_INLINE SinCos sin_cos(Pack x) {
  const Reduced q = reduce_pi(x);
  const Pack t = q.r * q.r;
  const Pack t2 = t * t;
  Pack s =
      madd(t2, -7.36464584423922492e-13, madd(t, 1.60473011452671512e-10, -2.50518514953321785e-8));
  Pack c = madd(t, -1.1032571550677335e-11, 2.08605293112427602e-9);
  s = madd(s, t2, madd(t, 2.75573160769817326e-6, -1.9841269820094026e-4));
  c = madd(c, t2, madd(t, -2.75570141224348093e-7, 2.48015842743742399e-5));
  s = madd(s, t2, madd(t, 8.3333333332628786e-3, -1.66666666666658121e-1));
  c = madd(c, t2, madd(t, -1.38888888741385679e-3, 4.16666666663984576e-2));
  // Rounded once near 1: at an inclination of 180 degrees SGP4 divides by 1 + cos i.
  c = madd(madd(c, t, -0.5), t, 1.0);
  s = madd(s, t * q.r, q.r);
  return {negate_odd(s, q.odd), negate_odd(c, q.odd)};
}

/// error 1.8e-11: for small corrections.
DMISE_INLINE Pack coarse_sin(Pack x) {
  const Pack shifted = madd(x, inv_pi, round_magic);
  const Pack r = nmadd(shifted - round_magic, 3.141592653589793116, x);
  const Pack t = r * r;
  const Pack t2 = t * t;
  Pack s =
      madd(t2, -2.3846693322029734e-8, madd(t, 2.75226188374002912e-6, -1.98408040395515355e-4));
  s = madd(s, t2, madd(t, 8.33333049568303221e-3, -1.66666666064676477e-1));
  return negate_odd(madd(s, t * r, r), shifted);
}
DMISE_INLINE Pack coarse_cos(Pack x) { return coarse_sin(x + 1.5707963267948966); }

/// error 1e-16 for |x| <= 1/16.
constexpr double small_angle = 1.0 / 16.0;
DMISE_INLINE SinCos small_sin_cos(Pack x) {
  const Pack t = x * x;
  const Pack t2 = t * t;
  const Pack s = madd(t2, -1.0 / 5040.0, madd(t, 1.0 / 120.0, -1.0 / 6.0));
  Pack c = madd(t2, 1.0 / 40320.0, madd(t, -1.0 / 720.0, 1.0 / 24.0));
  c = madd(c, t2, madd(t, -0.5, 1.0));
  return {madd(s, t * x, x), c};
}

/// error 6e-15 for |x| <= 1/32.
constexpr double short_angle = 1.0 / 32.0;
DMISE_INLINE SinCos short_sin_cos(Pack x) {
  const Pack t = x * x;
  const Pack s = madd(t, 1.0 / 120.0, -1.0 / 6.0);
  const Pack c = madd(t, madd(t, -1.0 / 720.0, 1.0 / 24.0), -0.5);
  return {madd(s, t * x, x), madd(c, t, 1.0)};
}

/// error 5e-16 for |x| <= 1/5.
constexpr double medium_angle = 0.2;
DMISE_INLINE SinCos medium_sin_cos(Pack x) {
  const Pack t = x * x;
  const Pack t2 = t * t;
  Pack s = madd(t, 1.0 / 362880.0, -1.0 / 5040.0);
  Pack c = madd(t2, -1.0 / 3628800.0, madd(t, 1.0 / 40320.0, -1.0 / 720.0));
  s = madd(s, t2, madd(t, 1.0 / 120.0, -1.0 / 6.0));
  c = madd(c, t2, madd(t, 1.0 / 24.0, -0.5));
  return {madd(s, t * x, x), madd(c, t, 1.0)};
}

/// error 6e-14 for |x| <= tiny_angle.
constexpr double tiny_angle = 1.1e-3;
DMISE_INLINE SinCos tiny_sin_cos(Pack x) {
  const Pack t = x * x;
  return {madd(t * x, -1.0 / 6.0, x), madd(t, -0.5, 1.0)};
}

/// Sine and cosine of a + b.
DMISE_INLINE SinCos turned(SinCos a, SinCos b) {
  return {madd(a.sin, b.cos, a.cos * b.sin), nmadd(a.sin, b.sin, a.cos * b.cos)};
}

/// error 4e-16 of the angle [-pi, pi] of (x, y); 0 at the origin.
DMISE_INLINE Pack angle_of(Pack y, Pack x) {
  const Pack ax = abs(x), ay = abs(y);
  const Mask steep = ax < ay;
  const Pack low = select(steep, ax, ay);
  const Pack high = select(steep, ay, ax);
  // atan(low / high) beyond tan(pi / 8) from 45 degrees.
  const Mask middle = Pack(0.41421356237309503) * high < low;
  const Pack num = select(middle, low - high, low);
  const Pack den = select(middle, low + high, high);
  const Pack z = select(den == 0.0, 0.0, num / den);
  const Pack t = z * z;
  Pack p = madd(t, -0.0247783861817377538, 0.0498182376114644234);
  p = madd(p, t, -0.0649163912718329651);
  p = madd(p, t, 0.0767093704503577623);
  p = madd(p, t, -0.0908925386924611048);
  p = madd(p, t, 0.11111031508283167);
  p = madd(p, t, -0.142857120473356025);
  p = madd(p, t, 0.199999999676520302);
  p = madd(p, t, -0.333333333331590084);
  Pack angle = madd(p * t, z, z);
  angle = select(middle, angle + 0.78539816339744830962, angle);
  angle = select(steep, Pack(1.57079632679489661923) - angle, angle);
  angle = select(x < 0.0, Pack(3.14159265358979323846) - angle, angle);
  return copy_sign(angle, y);
}

}  // namespace
}  // namespace dmise::sgp4
