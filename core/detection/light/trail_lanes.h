#pragma once
#include "core/detection/light/trail_shape.h"

#define DMISE_ALWAYS_INLINE static inline __attribute__((always_inline))

namespace dmise {
namespace {

/// Density and distribution at x0 + h, from those at x0.
template <class V>
DMISE_ALWAYS_INLINE V normal_pdf_near(V x0, V h, V p) {
  return p * (1 - h * (x0 - h * ((x0 * x0 - 1) / 2 - h * x0 * (x0 * x0 - 3) / 6)));
}
template <class V>
DMISE_ALWAYS_INLINE V normal_cdf_near(V x0, V h, V c, V p) {
  return c + p * h * (1 - h * (x0 / 2 - h * (x0 * x0 - 1) / 6));
}

/// A function and its first four derivatives.
template <class V>
struct FourDerivatives {
  V f, f1, f2, f3, f4;
};

/// The Gaussian of sigma 1/s at x/s, where its standard density is `p`, by Hermite's polynomials.
template <class V>
DMISE_ALWAYS_INLINE FourDerivatives<V> of_gaussian(V x, V p, double s) {
  const V x2 = x * x, ps = p * s;
  const double s2 = s * s;
  return {ps, -x * ps * s, (x2 - 1) * ps * s2, -x * (x2 - 3) * ps * s2 * s,
          (x2 * (x2 - 6) + 3) * ps * s2 * s2};
}

/// Electrons in the pixels (px, py), and their derivatives `d` by the parameters in the order of
/// `TrailParameter`. V is a number, or a vector of numbers; `normal` gives the normal
/// distribution's cdf and pdf at a V, `within(v)` v held to -1 .. 1.
template <class V, class Normal, class Within>
DMISE_ALWAYS_INLINE V light_of_trail(const TrailShape& t, V px, V py, const Normal& normal,
                                     const Within& within, V* d) {
  const V zero{};
  const V dx = px - t.x_px, dy = py - t.y_px;
  const V along = dx * t.cos_angle + dy * t.sin_angle, across = dy * t.cos_angle - dx * t.sin_angle;
  const double length = t.length_px;
  V w = zero + 1.0, w_along = zero, w_length = zero, w_slope = zero;
  V bend = zero, bend_along = zero, bend_length = zero, bend_sagitta = zero;
  if (!t.is_point) {
    const V free = 2 * along / length;  // -1 .. 1 from end to end
    const V r = within(free);
    const auto inside = r == free;
    w = 1 + t.slope * r;
    w_slope = r;
    bend_sagitta = 1.0 / 3 - r * r;
    bend = t.sagitta_px * bend_sagitta;
    w_along = inside ? zero + t.slope * 2 / length : zero;
    w_length = inside ? -t.slope * r / length : zero;
    bend_along = inside ? -t.sagitta_px * 4 * r / length : zero;
    bend_length = inside ? t.sagitta_px * 2 * r * r / length : zero;
  }
  const V off = across - bend;
  // Light along the line, per px, times the profile across it, and derivatives of that product.
  V ag = zero, along_g = zero, length_g = zero, ag_off = zero;
  for (std::size_t i = 0; i < t.parts; ++i) {
    const double s = t.along[i], sc = t.across[i];
    const V v = off * sc, density = normal.pdf(v), at = along - t.lean[i] * off;
    V a, a_along, a_length = zero, square = zero, up_pdf = zero, down_pdf = zero;
    if (t.is_point) {
      up_pdf = normal.pdf(at * s);
      a = up_pdf * s;
      a_along = -at * s * s * a;
    } else {
      V up_cdf, down_cdf;
      normal.both((at + length / 2) * s, up_cdf, up_pdf);
      normal.both((at - length / 2) * s, down_cdf, down_pdf);
      a = (up_cdf - down_cdf) / length;
      a_along = (up_pdf - down_pdf) * s / length;
      a_length = ((up_pdf + down_pdf) * s / 2 - a) / length;
    }
    if (t.is_narrow[i]) {
      const FourDerivatives<V> across_line = of_gaussian(v, density, sc);
      FourDerivatives<V> line;
      if (t.is_point) {
        line = of_gaussian<V>(at * s, up_pdf, s);
      } else {
        const FourDerivatives<V> end = of_gaussian<V>((at + length / 2) * s, up_pdf, s);
        const FourDerivatives<V> start = of_gaussian<V>((at - length / 2) * s, down_pdf, s);
        line = {a, a_along, (end.f1 - start.f1) / length, (end.f2 - start.f2) / length,
                (end.f3 - start.f3) / length};
      }
      square = t.fourth * (line.f4 * across_line.f + line.f * across_line.f4) +
               t.mixed * line.f2 * across_line.f2 +
               t.odd * (line.f3 * across_line.f1 - line.f1 * across_line.f3);
    }
    const V g = t.weight[i] * density * sc;
    ag += a * g + t.weight[i] * square;
    along_g += a_along * g;
    length_g += a_length * g;
    ag_off -= (a * off * sc * sc + t.lean[i] * a_along) * g;
  }
  const double f = t.flux_e;
  const V by_along = f * (along_g * w + ag * w_along - w * ag_off * bend_along);
  const V by_across = f * w * ag_off;
  d[0] = -by_along * t.cos_angle + by_across * t.sin_angle;
  d[1] = -by_along * t.sin_angle - by_across * t.cos_angle;
  d[2] = w * ag;
  d[3] = f * (length_g * w + ag * w_length - w * ag_off * bend_length);
  d[4] = by_along * across - by_across * along;
  d[5] = f * ag * w_slope;
  d[6] = -by_across * bend_sagitta;
  return f * d[2];
}

}  // namespace
}  // namespace dmise
