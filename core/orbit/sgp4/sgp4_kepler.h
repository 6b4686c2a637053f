// Kepler's equation on packs of objects, with the iteration and the stopping rule of the reference:
// the last step enters the anomaly but not its sine and cosine. Included only by sgp4_kernel.h.
#pragma once
#include "core/orbit/sgp4/sgp4_kernels.h"
#include "core/orbit/sgp4/sgp4_trig.h"

namespace dmise::sgp4 {
namespace {

/// Solution of Kepler's equation: sine and cosine of the eccentric longitude, and derived
/// quantities.
struct Anomaly {
  SinCos e;
  Pack e_sin, e_cos;  // e sin E, e cos E of the eccentric anomaly
  Pack inv_rho;       // 1 / (1 - e cos E)
};

/// 1 / (1 - x), error x^4.
DMISE_INLINE Pack inverse_of_one_minus(Pack x) { return madd(madd(x + 1.0, x, 1.0), x, 1.0); }
/// 1 / (1 - x) with an error of x^6.
DMISE_INLINE Pack inverse_of_one_minus_6(Pack x) {
  const Pack x2 = x * x;
  const Pack y = x + 1.0;
  return madd(madd(x2, x2, x2), y, y);
}

/// Small eccentricity: the reference's iteration as rotations from `u`, given its sine and cosine.
/// Three evaluations suffice for e < 0.026, four for e < 0.18; lanes that have not converged are
/// marked in `outside`.
template <Shape shape>
DMISE_INLINE Anomaly solve_kepler_by_turns(SinCos su, Pack ax, Pack ay, Mask& outside) {
  static_assert(shape != Shape::any);
  const Pack cos0 = madd(ax, su.cos, ay * su.sin);
  const Pack sin0 = nmadd(ay, su.cos, ax * su.sin);
  Anomaly out;
  const auto turn_by = [&](Pack d) __attribute__((always_inline)) {
    const SinCos turn = shape == Shape::circle ? short_sin_cos(d) : medium_sin_cos(d);
    out.e_sin = madd(sin0, turn.cos, cos0 * turn.sin);
    out.e_cos = nmadd(sin0, turn.sin, cos0 * turn.cos);
    return turn;
  };
  // The reference may stop here, with a last step below 1e-12, where the first one is good to
  // 3e-15. The series of 1 / rho is good to 4e-10 of a step of e^3 / 2.
  out.inv_rho =
      shape == Shape::circle ? inverse_of_one_minus_6(cos0) : Pack(1.0) / (Pack(1.0) - cos0);
  Pack d = sin0 * out.inv_rho;
  for (int k = 0; k < (shape == Shape::circle ? 1 : 2); ++k) {
    turn_by(d);
    const Pack h = nmadd(Pack(1.0) - out.e_cos, out.inv_rho, 1.0);
    const Pack h_series = shape == Shape::circle ? madd(h, h, h) : madd(madd(h, h, h), h, h);
    out.inv_rho = madd(out.inv_rho, h_series, out.inv_rho);
    const Pack step = (out.e_sin - d) * out.inv_rho;
    d = select(abs(step) < 1e-12, d, d + step);
  }
  out.e = turned(su, turn_by(d));
  const Pack h = nmadd(Pack(1.0) - out.e_cos, out.inv_rho, 1.0);
  out.inv_rho = madd(out.inv_rho, h, out.inv_rho);  // to 1e-13
  outside = ~(abs((out.e_sin - d) * out.inv_rho) < 1e-12);
  return out;
}

/// Any eccentricity: the reference's iteration, each lane to its own stop. Sine and cosine are
/// rotated by small steps and recomputed after larger ones.
DMISE_INLINE Anomaly solve_kepler(Pack u, Pack ax, Pack ay) {
  const Pack turns = madd(u, 0.5 * inv_pi, round_magic) - round_magic;
  u = minus_k_pi(u, turns + turns);
  Pack anomaly = u;
  SinCos e = sin_cos(u);
  Pack e_sin, e_cos, rho;
  Mask active = u == u;
  for (int k = 0;; ++k) {
    e_cos = madd(ax, e.cos, ay * e.sin);
    e_sin = nmadd(ay, e.cos, ax * e.sin);
    rho = Pack(1.0) - e_cos;
    Pack step = (u + e_sin - anomaly) / rho;
    active = active & (Pack(1e-12) <= abs(step));
    if (k == 9 || !any(active)) break;
    step = select(Pack(0.95) <= abs(step), copy_sign(0.95, step), step);
    step = select(active, step, 0.0);  // a converged lane stays unchanged
    anomaly = anomaly + step;
    const Mask large = ~(abs(step) <= small_angle);
    const SinCos from = e;
    e = turned(from, small_sin_cos(step));
    if (any(large)) {
      const SinCos full = sin_cos(anomaly);
      e.sin = select(large, full.sin, e.sin);
      e.cos = select(large, full.cos, e.cos);
    }
  }
  return {e, e_sin, e_cos, Pack(1.0) / rho};
}

}  // namespace
}  // namespace dmise::sgp4
