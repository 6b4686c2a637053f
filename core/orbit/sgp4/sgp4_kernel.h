// SGP4 on packs of objects, one source for every instruction set: included only by
// sgp4_kernel_SET.cpp. Each lane's result depends on that lane alone: if the lanes of
// a pack take different branches, the pack evaluates both and each lane selects its own.
//
// Changes of form, not of result, against the scalar reference:
// - mean anomaly and argument of perigee are used only as their sum, and the node separately;
// - (sin u, cos u) are rotated by the small short-period corrections, so that no arc tangent is
//   needed; sin and cos of the eccentric anomaly are rotated from those of the longitude;
// - near a circle, inverses and roots close to 1 are short series: the latency of the divisions
//   limits a pack, not the number of operations;
// - Kepler's iteration is the reference's, including its stopping rule, after which the last
//   correction is in the anomaly but not in its sine and cosine.
#pragma once
#include "core/orbit/sgp4/sgp4_kepler.h"
#include "core/orbit/sgp4/sgp4_kernels.h"
#include "core/orbit/sgp4/sgp4_store.h"
#include "core/orbit/sgp4/sgp4_terms.h"
#include "core/orbit/sgp4/sgp4_trig.h"

namespace dmise::sgp4 {
namespace {

DMISE_INLINE Pack at(const Lanes& lanes, int first) { return load(lanes.lane + first); }

/// Prefetch of the next block, issued in four places because the cache holds few outstanding
/// requests.
struct Ahead {
  const char* from = nullptr;
  std::size_t quarter_bytes = 0;
};
DMISE_INLINE void fetch(const Ahead& a, std::size_t quarter) {
  const char* from = a.from + quarter * a.quarter_bytes;
  for (std::size_t k = 0; k < a.quarter_bytes; k += 64) __builtin_prefetch(from + k);
}

/// One of `parts` pieces of a block.
template <class Block>
DMISE_INLINE Ahead part_of(const Block* block, std::size_t part, std::size_t parts) {
  constexpr std::size_t lines = sizeof *block / 64;
  const std::size_t quarter = (lines + 4 * parts - 1) / (4 * parts) * 64;
  const std::size_t start = 4 * quarter * part;
  return {reinterpret_cast<const char*>(block) + start, start < sizeof *block ? quarter : 0};
}

/// Mean elements at the time, including periodic terms of the Sun and Moon.
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
  Ahead ahead;
};

struct States {
  Pack x, y, z, vx, vy, vz;
  Mask bad;
  Pack code;  // error, 0 if none
};

/// `a` rotated by a correction; `Tiny`: by at most tiny_angle.
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

/// Long- and short-period terms and the state. All shapes but `any` use approximations for small
/// eccentricity above the surface and mark the lanes outside their range in `outside`. Terms
/// independent of the anomaly come first, to hide the latency of Kepler's iteration.
template <Shape shape>
DMISE_INLINE States finish(const Mean& m, Mask& outside) {
  constexpr bool turns = shape != Shape::any;
  // Long-period terms.
  const SinCos argp = sin_cos(m.argp);
  SinCos longitude;
  if constexpr (turns) longitude = sin_cos(m.longitude);
  // 1 / (1 - e^2) is a factor of terms of 1e-3: to 4e-13 where the series stands for it.
  constexpr bool series = shape == Shape::circle;
  const Pack k =
      series ? m.inv_a * inverse_of_one_minus(m.e * m.e) : m.inv_a / nmadd(m.e, m.e, 1.0);
  const Pack ax = m.e * argp.cos;
  const Pack ay = madd(m.e, argp.sin, k * (m.sin_i * (-0.5 * j3_over_j2)));
  const Pack long_period = k * m.long_period * ax;

  const Pack e2 = madd(ay, ay, ax * ax);
  const Pack beta2 = Pack(1.0) - e2;
  const Pack inv_p = series ? m.inv_a * inverse_of_one_minus(e2) : m.inv_a / beta2;
  Pack beta, inv_1_beta;
  if constexpr (series) {
    // Series of 1 / (1 + beta) = (1 - beta) / e^2 in e^2, error 2e-17.
    inv_1_beta = madd(e2, 5.0 / 128.0, 1.0 / 16.0);
    inv_1_beta = madd(madd(inv_1_beta, e2, 1.0 / 8.0), e2, 0.5);
    beta = nmadd(e2, inv_1_beta, 1.0);
  } else {
    beta = sqrt(beta2);
    inv_1_beta = Pack(1.0) / (Pack(1.0) + beta);
  }

  fetch(m.ahead, 2);
  Anomaly ea;
  if constexpr (turns) {
    ea = solve_kepler_by_turns<shape>(corrected<true>(longitude, long_period), ax, ay, outside);
    constexpr double e_limit = shape == Shape::circle ? 0.027 : 0.19;
    outside = outside | ~(abs(long_period) <= tiny_angle) | ~(e2 <= e_limit * e_limit);
  } else {
    ea = solve_kepler(m.longitude + long_period, ax, ay);
  }

  fetch(m.ahead, 3);
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
  const SinCos su = corrected<turns>({sin_u, cos_u}, k2 * madd(cos2_i, -1.75, 0.25) * sin_2u);
  const SinCos inc = corrected<turns>({m.sin_i, m.cos_i}, k2_cos * m.sin_i * cos_2u);
  const SinCos nod = corrected<turns>(m.node, k2_cos * sin_2u);
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

  if constexpr (turns) outside = outside | ~(k2 <= tiny_angle / 1.5);
  // Only lanes with a radius between these are good; NaN fails the test.
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

/// Recomputes the lanes of `outside` by the general branch.
[[gnu::noinline]] void replace_outside(const Mean& m, Mask outside, States& s) {
  Mask unused;
  const States full = finish<Shape::any>(m, unused);
  s.code = select(outside & full.bad, full.code, s.code);
  s.bad = (outside & full.bad) | (~outside & s.bad);
  s.x = select(outside, full.x, s.x);
  s.y = select(outside, full.y, s.y);
  s.z = select(outside, full.z, s.z);
  s.vx = select(outside, full.vx, s.vx);
  s.vy = select(outside, full.vy, s.vy);
  s.vz = select(outside, full.vz, s.vz);
}

/// `finish`, with the valid branch for each lane.
template <Shape shape>
DMISE_INLINE States finish_each(const Mean& m) {
  Mask outside;
  States s = finish<shape>(m, outside);
  if constexpr (shape != Shape::any) {
    if (any(outside)) [[unlikely]] {
      const Mean in_memory = m;
      States replaced = s;
      replace_outside(in_memory, outside, replaced);
      s = replaced;
    }
  }
  return s;
}

DMISE_INLINE Pack minutes(const SecularTerms<Lanes>& s, int first, double jd1, double jd2) {
  return (Pack(jd1) - at(s.epoch_jd1, first)) * minutes_per_day +
         (Pack(jd2) - at(s.epoch_jd2, first)) * minutes_per_day;
}

// NaN passes these tests and fails the last one, on the radius.
DMISE_INLINE Mask eccentricity_fails(Pack e) { return (e < -0.001) | (Pack(1.0) <= e); }
DMISE_INLINE Pack within_span(Pack t) {
  return select(abs(t) <= longest_span_min, t, __builtin_nan(""));
}

/// Writes a pack's states and codes to `to`; zeros where there is no state.
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

struct BlockPlaces {
  Places of[block_lanes / one_lanes];
};
DMISE_INLINE BlockPlaces block_places(const std::uint32_t* index, std::size_t objects) {
  BlockPlaces places;
  for (std::size_t k = 0; k < block_lanes; k += one_lanes)
    places.of[k / one_lanes] = places_of(index + k, objects > k ? objects - k : 0);
  return places;
}

/// Writes a pack's states; zeros and a code where there is no state. `out` is the output of the
/// time.
DMISE_INLINE void put(States s, int first, const BlockPlaces& places, const Output& out) {
  const Places& a = places.of[first / one_lanes];
  const Places& b = places.of[first / one_lanes + 1];
  const unsigned bad = bits(s.bad) & ((1u << (a.count + b.count)) - 1u);
  if (bad) [[unlikely]] {
    alignas(64) double code[pack_lanes];
    store(code, s.code);
    for (unsigned k = 0; k < pack_lanes; ++k)
      if (bad >> k & 1u) out.code[a.index[k]] = std::uint8_t(code[k]);
    s.x = select(s.bad, 0.0, s.x), s.y = select(s.bad, 0.0, s.y), s.z = select(s.bad, 0.0, s.z);
    s.vx = select(s.bad, 0.0, s.vx), s.vy = select(s.bad, 0.0, s.vy);
    s.vz = select(s.bad, 0.0, s.vz);
  }
  put({{s.x.a, s.y.a, s.z.a, s.vx.a, s.vy.a, s.vz.a}}, a, out);
  put({{s.x.b, s.y.b, s.z.b, s.vx.b, s.vy.b, s.vz.b}}, b, out);
}

DMISE_INLINE Output of_time(const Output& out, std::size_t k) {
  return {out.position + 3 * k * out.stride, out.velocity + 3 * k * out.stride,
          out.code + k * out.stride, out.stride};
}

}  // namespace
}  // namespace dmise::sgp4

#include "core/orbit/sgp4/sgp4_deep_kernel.h"
#include "core/orbit/sgp4/sgp4_near_kernel.h"
