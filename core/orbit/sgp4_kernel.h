// SGP4 on packs of objects, the one source of every instruction set: included by
// sgp4_kernel_{sse2,avx2,avx512}.cpp alone. Each lane's result depends on that lane alone: where
// lanes of a pack want different roads, the pack takes both and each lane keeps its own.
//
// Against the reference's scalar code, without changing what is computed:
// - mean anomaly and argument of perigee are only ever needed as their sum, and the node apart;
// - (sin u, cos u) of the short-period terms are turned by their small corrections, so that no arc
//   tangent is taken; sin and cos of the eccentric anomaly are turned from those of the longitude;
// - Kepler's iterations are the reference's own, including its stop, after which the last
// correction
//   is in the anomaly but not in its sine and cosine.
#pragma once
#include "core/orbit/sgp4_kernels.h"
#include "core/orbit/sgp4_terms.h"
#include "core/orbit/sgp4_trig.h"

namespace dmise::sgp4 {
namespace {

DMISE_INLINE Pack at(const Lanes& lanes, int first) { return load(lanes.lane + first); }

/// Mean elements at the time, periodic terms of the Sun and Moon included.
struct Mean {
  Pack e;          // eccentricity
  Pack argp;       // argument of perigee
  Pack longitude;  // mean anomaly + argument of perigee
  SinCos node;
  Pack sin_i, cos_i;
  Pack long_period;             // coefficient
  Pack a_m, inv_a, inv_sqrt_a;  // semi-major axis [m], [Earth radii^-1], [Earth radii^-1/2]
  Pack farthest_m;
  Mask code1, code2, code3;
};

struct States {
  Pack x, y, z, vx, vy, vz;
  Mask bad;
  Pack code;  // where bad
};

/// Kepler's equation solved for the sine and cosine of the eccentric longitude, and what they give.
struct Anomaly {
  SinCos e;
  Pack e_sin, e_cos;  // e sin E, e cos E of the eccentric anomaly
  Pack inv_rho;       // 1 / (1 - e cos E)
};

/// For e below 0.06 or so: three of the reference's evaluations, as turns from `u`, given its sine
/// and cosine. Lanes for which the reference would go on are in `outside`.
DMISE_INLINE Anomaly solve_kepler_near_circle(SinCos su, Pack ax, Pack ay, Mask& outside) {
  const Pack cos0 = madd(ax, su.cos, ay * su.sin);
  const Pack sin0 = nmadd(ay, su.cos, ax * su.sin);
  const Pack d1 = sin0 / (Pack(1.0) - cos0);
  SinCos turn = small_sin_cos(d1);
  Pack e_sin = madd(sin0, turn.cos, cos0 * turn.sin);
  Pack e_cos = nmadd(sin0, turn.sin, cos0 * turn.cos);
  const Pack step = (e_sin - d1) / (Pack(1.0) - e_cos);
  const Pack d = select(abs(step) < 1e-12, d1, d1 + step);
  turn = small_sin_cos(d);
  e_sin = madd(sin0, turn.cos, cos0 * turn.sin);
  e_cos = nmadd(sin0, turn.sin, cos0 * turn.cos);
  const Pack inv_rho = Pack(1.0) / (Pack(1.0) - e_cos);
  const Mask settled = abs((e_sin - d) * inv_rho) < 1e-12;
  outside = ~(settled & (abs(d1) <= small_angle));
  return {turned(su, turn), e_sin, e_cos, inv_rho};
}

/// Any eccentricity: the reference's iteration, lane by lane to its own stop.
DMISE_INLINE Anomaly solve_kepler(Pack u, Pack ax, Pack ay) {
  const Pack turns = madd(u, 0.5 * inv_pi, round_magic) - round_magic;
  u = minus_k_pi(u, turns + turns);
  Anomaly out;
  out.e = {0.0, 0.0};
  out.e_sin = out.e_cos = out.inv_rho = 0.0;
  Pack anomaly = u;
  Mask active = u == u;
  for (int k = 0; k < 10 && any(active); ++k) {
    const SinCos e = sin_cos(anomaly);
    const Pack e_cos = madd(ax, e.cos, ay * e.sin);
    const Pack e_sin = nmadd(ay, e.cos, ax * e.sin);
    const Pack rho = Pack(1.0) - e_cos;
    Pack step = (u + e_sin - anomaly) / rho;
    step = select(Pack(0.95) <= abs(step), copy_sign(0.95, step), step);
    out.e.sin = select(active, e.sin, out.e.sin);
    out.e.cos = select(active, e.cos, out.e.cos);
    out.e_sin = select(active, e_sin, out.e_sin);
    out.e_cos = select(active, e_cos, out.e_cos);
    out.inv_rho = select(active, rho, out.inv_rho);
    anomaly = anomaly + step;
    active = active & (Pack(1e-12) <= abs(step));
  }
  out.inv_rho = Pack(1.0) / out.inv_rho;
  return out;
}

/// `a` turned by a correction: by a tiny one, or by any.
template <bool Tiny>
DMISE_INLINE SinCos corrected(SinCos a, Pack by) {
  if constexpr (Tiny) return turned(a, tiny_sin_cos(by));
  SinCos turn = small_sin_cos(by);
  const Mask large = ~(abs(by) <= small_angle);
  if (any(large)) [[unlikely]] {
    const SinCos full = sin_cos(by);
    turn.sin = select(large, full.sin, turn.sin);
    turn.cos = select(large, full.cos, turn.cos);
  }
  return turned(a, turn);
}

/// Long- and short-period terms and the state. `NearCircle` takes the short cuts that hold for
/// small eccentricity above the surface and marks in `outside` the lanes for which they don't. What
/// does not depend on the anomaly stands before it, to fill the waits of Kepler's iterations.
template <bool NearCircle>
DMISE_INLINE States finish(const Mean& m, Mask& outside) {
  // Long-period terms.
  const SinCos argp = sin_cos(m.argp);
  SinCos longitude;
  if constexpr (NearCircle) longitude = sin_cos(m.longitude);
  const Pack k = m.inv_a / nmadd(m.e, m.e, 1.0);
  const Pack ax = m.e * argp.cos;
  const Pack ay = madd(m.e, argp.sin, k * (m.sin_i * (-0.5 * j3_over_j2)));
  const Pack long_period = k * m.long_period * ax;

  const Pack beta2 = nmadd(ay, ay, nmadd(ax, ax, 1.0));
  const Pack beta = sqrt(beta2);
  const Pack inv_p = m.inv_a / beta2;
  const Pack inv_1_beta = Pack(1.0) / (Pack(1.0) + beta);

  Anomaly ea;
  if constexpr (NearCircle) {
    ea = solve_kepler_near_circle(corrected<true>(longitude, long_period), ax, ay, outside);
    outside = outside | ~(abs(long_period) <= tiny_angle);
  } else {
    ea = solve_kepler(m.longitude + long_period, ax, ay);
  }

  // Short-period terms.
  constexpr double velocity_unit = earth_radius_m * xke / 60.0;
  const Pack k1 = inv_p * (0.5 * j2);
  const Pack k2 = k1 * inv_p;
  const Pack cos2_i = m.cos_i * m.cos_i;
  const Pack con41_15 = madd(cos2_i, 4.5, -1.5);  // 1.5 (3 cos^2 i - 1)
  const Pack sin2_i = Pack(1.0) - cos2_i;
  const Pack k2_cos = k2 * 1.5 * m.cos_i;
  const Pack speed = m.inv_sqrt_a * velocity_unit;
  const Pack v2 = speed * m.inv_a * k1;
  const Pack v2_sin2_i = v2 * sin2_i;
  const Pack r_scale = m.a_m * nmadd(k2 * beta, con41_15, 1.0);

  const Pack q = ea.e_sin * inv_1_beta;
  const Pack sin_u = ea.inv_rho * (nmadd(ax, q, ea.e.sin) - ay);
  const Pack cos_u = ea.inv_rho * (madd(ay, q, ea.e.cos) - ax);
  const Pack two_sin = sin_u + sin_u;
  const Pack sin_2u = two_sin * cos_u;
  const Pack cos_2u = nmadd(two_sin, sin_u, 1.0);
  const Pack r_m =
      madd(k1 * (0.5 * earth_radius_m) * sin2_i, cos_2u, nmadd(r_scale, ea.e_cos, r_scale));
  const Pack v1 = speed * ea.inv_rho;
  const Pack v_radial = nmadd(v2_sin2_i, sin_2u, v1 * ea.e_sin);
  const Pack v_along = madd(v2_sin2_i, cos_2u, madd(v2, con41_15, v1 * beta));

  // Orientation.
  const SinCos su = corrected<NearCircle>({sin_u, cos_u}, k2 * madd(cos2_i, -1.75, 0.25) * sin_2u);
  const SinCos inc = corrected<NearCircle>({m.sin_i, m.cos_i}, k2_cos * m.sin_i * cos_2u);
  const SinCos nod = corrected<NearCircle>(m.node, k2_cos * sin_2u);
  const Pack px = r_m * su.cos, py = r_m * su.sin;
  const Pack wx = nmadd(v_along, su.sin, v_radial * su.cos);
  const Pack wy = madd(v_along, su.cos, v_radial * su.sin);
  const Pack qx = nod.sin * inc.cos, qy = nod.cos * inc.cos;
  States out;
  out.x = nmadd(qx, py, nod.cos * px);
  out.y = madd(qy, py, nod.sin * px);
  out.z = inc.sin * py;
  out.vx = nmadd(qx, wy, nod.cos * wx);
  out.vy = madd(qy, wy, nod.sin * wx);
  out.vz = inc.sin * wy;

  if constexpr (NearCircle) outside = outside | ~(k2 <= tiny_angle / 1.5);
  // Only a lane whose radius is an ordinary number between these is good; not a number is not.
  const Mask in_range = (Pack(earth_radius_m) <= r_m) & (r_m <= m.farthest_m);
  out.bad = m.code1 | m.code2 | m.code3 | ~in_range;
  if (any(out.bad)) [[unlikely]] {
    Pack code = select(r_m < earth_radius_m, Pack(6.0), Pack(7.0));
    code = select(beta2 < 0.0, 4.0, code);
    code = select(m.code3, 3.0, code);
    code = select(m.code1, 1.0, code);
    out.code = select(m.code2, 2.0, code);
  }
  return out;
}

/// `finish`, each lane by the road that holds for it. `eccentric`: none takes the short cuts.
DMISE_INLINE States finish_each(const Mean& m, bool eccentric) {
  Mask outside;
  if (eccentric) return finish<false>(m, outside);
  States s = finish<true>(m, outside);
  if (any(outside)) [[unlikely]] {
    Mask unused;
    const States full = finish<false>(m, unused);
    s.code = select(outside & full.bad, full.code, s.code);
    s.bad = (outside & full.bad) | (~outside & s.bad);
    s.x = select(outside, full.x, s.x);
    s.y = select(outside, full.y, s.y);
    s.z = select(outside, full.z, s.z);
    s.vx = select(outside, full.vx, s.vx);
    s.vy = select(outside, full.vy, s.vy);
    s.vz = select(outside, full.vz, s.vz);
  }
  return s;
}

DMISE_INLINE Pack minutes(const SecularTerms<Lanes>& s, int first, double jd1, double jd2) {
  return (Pack(jd1) - at(s.epoch_jd1, first)) * minutes_per_day +
         (Pack(jd2) - at(s.epoch_jd2, first)) * minutes_per_day;
}

// What is not a number passes these tests and fails the last one, on the radius.
DMISE_INLINE Mask eccentricity_fails(Pack e) { return (e < -0.001) | (Pack(1.0) <= e); }
DMISE_INLINE Pack within_span(Pack t) {
  return select(abs(t) <= longest_span_min, t, __builtin_nan(""));
}

DMISE_INLINE States near_states(const NearTerms<Lanes>& b, int first, Pack t, bool eccentric) {
  t = within_span(t);
  const SecularTerms<Lanes>& s = b.secular;
  const Pack t2 = t * t;
  const Pack m0 = madd(at(s.m_dot, first), t, at(s.m, first));
  const Pack argp0 = madd(at(s.argp_dot, first), t, at(s.argp, first));

  Mean m;
  m.node =
      sin_cos(madd(at(s.node_t2, first), t2, madd(at(s.node_dot, first), t, at(s.node, first))));
  const Pack c = madd(at(b.eta, first), coarse_cos(m0), 1.0);
  const Pack shift = madd(at(b.m_cubic, first) * c, c * c,
                          madd(at(b.m_linear, first), t, Pack(0.0) - at(b.m_cubic0, first)));
  Pack e = madd(at(s.e_dot, first), t, at(s.e, first));
  e = nmadd(at(b.e_sin, first), coarse_sin(m0 + shift), e);

  Pack a = madd(at(b.a_t4, first), t, at(b.a_t3, first));
  a = madd(a, t, at(b.a_t2, first));
  a = madd(a, t, at(s.a_t, first));
  a = nmadd(a, t, 1.0);
  Pack l = madd(at(b.l_t5, first), t, at(b.l_t4, first));
  l = madd(l, t, at(b.l_t3, first));
  l = madd(l, t, at(s.l_t2, first));

  m.code1 = eccentricity_fails(e);
  m.code2 = m.code3 = Pack(1.0) < 0.0;
  m.e = max(e, 1e-6);
  m.argp = argp0 - shift;
  m.longitude = madd(l, t2, m0 + argp0);
  m.sin_i = at(b.sin_i, first);
  m.cos_i = at(b.cos_i, first);
  m.long_period = at(b.long_period, first);
  m.a_m = at(s.a0_m, first) * a * a;
  m.inv_sqrt_a = at(s.inv_sqrt_a0, first) / abs(a);
  m.inv_a = m.inv_sqrt_a * m.inv_sqrt_a;
  m.farthest_m = at(s.farthest_m, first);
  return finish_each(m, eccentric);
}

/// Writes a pack's states to `to`, codes included; zeros where there is none.
DMISE_INLINE void put(const States& s, int first, BlockStates& to) {
  store(to.position[0] + first, s.x);
  store(to.position[1] + first, s.y);
  store(to.position[2] + first, s.z);
  store(to.velocity[0] + first, s.vx);
  store(to.velocity[1] + first, s.vy);
  store(to.velocity[2] + first, s.vz);
  const unsigned bad = bits(s.bad);
  for (int k = 0; k < pack_lanes; ++k) to.code[first + k] = 0;
  if (bad) [[unlikely]] {
    alignas(64) double code[pack_lanes];
    store(code, s.code);
    for (int k = 0; k < pack_lanes; ++k) {
      if (!(bad >> k & 1u)) continue;
      to.code[first + k] = static_cast<unsigned char>(code[k]);
      for (auto& axis : to.position) axis[first + k] = 0.0;
      for (auto& axis : to.velocity) axis[first + k] = 0.0;
    }
  }
}

DMISE_INLINE void scatter(const BlockStates& from, const std::uint32_t* index, int count,
                          const Output& out) {
  const auto put_row = [&](const auto* row, auto* to) {
    if (count == block_lanes && index[block_lanes - 1] - index[0] == block_lanes - 1) {
      __builtin_memcpy(to + index[0], row, block_lanes * sizeof *row);  // neighbours, ascending
      return;
    }
    for (int k = 0; k < count; ++k) to[index[k]] = row[k];
  };
  put_row(from.code, out.code);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put_row(from.position[axis], out.position + axis * out.stride);
    put_row(from.velocity[axis], out.velocity + axis * out.stride);
  }
}

void near_blocks(const NearTerms<Lanes>* blocks, const std::uint32_t* index, std::size_t objects,
                 bool eccentric, double jd1, double jd2, const Output& out) {
  BlockStates states;
  for (std::size_t done = 0; done < objects; done += block_lanes, ++blocks, index += block_lanes) {
    for (int first = 0; first < block_lanes; first += pack_lanes) {
      put(near_states(*blocks, first, minutes(blocks->secular, first, jd1, jd2), eccentric), first,
          states);
    }
    const std::size_t left = objects - done;
    scatter(states, index, left < block_lanes ? int(left) : block_lanes, out);
  }
}

void near_block(const NearTerms<Lanes>& block, bool eccentric, const Lanes& t, BlockStates& out) {
  for (int first = 0; first < block_lanes; first += pack_lanes)
    put(near_states(block, first, at(t, first), eccentric), first, out);
}

}  // namespace
}  // namespace dmise::sgp4

#include "core/orbit/sgp4_deep_kernel.h"
