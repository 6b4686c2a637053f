// Deep-space terms on packs of objects: Sun, Moon and resonance. Included only by sgp4_kernel.h.
#pragma once
#include "core/orbit/sgp4/sgp4_kernels.h"
#include "core/orbit/sgp4/sgp4_terms.h"
#include "core/orbit/sgp4/sgp4_trig.h"

extern "C" double cbrt(double) noexcept;

namespace dmise::sgp4 {
namespace {

struct Slopes {
  Pack n_dot, n_ddot;
};

DMISE_INLINE Slopes slopes(const SynchronousTerms<Lanes>& b, int first, Pack lambda, Pack n, Pack) {
  // Sines of lambda - 0.13130908, 2 (lambda - 2.8843198) and 3 (lambda - 0.37448087) follow from
  // those of multiples of lambda.
  const SinCos l = sin_cos(lambda);
  const SinCos l2 = turned(l, l);
  const SinCos l3 = turned(l2, l);
  constexpr double s1 = 0.130932065016401008, c1 = 0.991391342684885936;
  constexpr double s2 = -0.492139430489155422, c2 = 0.870516387529729252;
  constexpr double s3 = 0.90159499016666413, c3 = 0.432581175857633466;
  const Pack del1 = at(b.del1, first), del2 = at(b.del2, first), del3 = at(b.del3, first);
  const Pack sin1 = l.sin * c1 - l.cos * s1, cos1 = l.cos * c1 + l.sin * s1;
  const Pack sin2 = l2.sin * c2 - l2.cos * s2, cos2 = l2.cos * c2 + l2.sin * s2;
  const Pack sin3 = l3.sin * c3 - l3.cos * s3, cos3 = l3.cos * c3 + l3.sin * s3;
  const Pack lambda_dot = n + at(b.drift, first);
  const Pack sum = madd(del1, cos1, madd(del2 * 2.0, cos2, del3 * 3.0 * cos3));
  return {madd(del1, sin1, madd(del2, sin2, del3 * sin3)), sum * lambda_dot};
}

/// Adds d sin(a - g) and weight d cos(a - g), given sine and cosine of a.
DMISE_INLINE void add_harmonic(SinCos a, Pack d, double sin_g, double cos_g, Pack& s, Pack& c) {
  s = madd(d, a.sin * cos_g - a.cos * sin_g, s);
  c = madd(d, a.cos * cos_g + a.sin * sin_g, c);
}

DMISE_INLINE Slopes slopes(const HalfDayTerms<Lanes>& b, int first, Pack lambda, Pack n,
                           Pack time) {
  const SinCos l = sin_cos(lambda);
  const SinCos w = sin_cos(madd(at(b.argp_dot, first), time, at(b.argp, first)));
  const SinCos minus_w = {Pack(0.0) - w.sin, w.cos};
  const SinCos w2 = turned(w, w);
  const SinCos l2 = turned(l, l);
  const SinCos lw = turned(l, w), l_w = turned(l, minus_w);
  // Phases 5.7686396 (22), 0.95240898 (32), 1.8014998 (44), 1.0508330 (52), 4.4108898 (54).
  constexpr double s22 = -0.492139430489155422, c22 = 0.870516387529729252;
  constexpr double s32 = 0.814814406163892493, c32 = 0.579721901870011493;
  constexpr double s44 = 0.973505778018079931, c44 = -0.228662415288155483;
  constexpr double s52 = 0.867837401281277346, c52 = 0.496848311798841878;
  constexpr double s54 = -0.95489237761530015, c54 = -0.296952095753168622;
  Pack s = 0.0, c = 0.0, twice_s = 0.0, twice_c = 0.0;
  add_harmonic(turned(l, w2), at(b.d2201, first), s22, c22, s, c);
  add_harmonic(l, at(b.d2211, first), s22, c22, s, c);
  add_harmonic(lw, at(b.d3210, first), s32, c32, s, c);
  add_harmonic(l_w, at(b.d3222, first), s32, c32, s, c);
  add_harmonic(lw, at(b.d5220, first), s52, c52, s, c);
  add_harmonic(l_w, at(b.d5232, first), s52, c52, s, c);
  add_harmonic(turned(l2, w2), at(b.d4410, first), s44, c44, twice_s, twice_c);
  add_harmonic(l2, at(b.d4422, first), s44, c44, twice_s, twice_c);
  add_harmonic(turned(l2, w), at(b.d5421, first), s54, c54, twice_s, twice_c);
  add_harmonic(turned(l2, minus_w), at(b.d5433, first), s54, c54, twice_s, twice_c);
  const Pack lambda_dot = n + at(b.drift, first);
  return {s + twice_s, madd(twice_c, 2.0, c) * lambda_dot};
}

struct Resonant {
  Pack lambda, n;
};

/// Longitude and mean motion at `t`, by Euler-Maclaurin steps of 720 min on the grid from the
/// epoch; the last node of the grid does not depend on earlier calls. `node` caches it: used if it
/// lies between epoch and t, replaced by the node that t needs.
template <class Terms>
DMISE_INLINE Resonant integrate(const Terms& b, int first, Pack t, ResonanceNode& node) {
  constexpr double step = resonance_step_min;
  const Pack steps = abs(t) * (1.0 / step);
  Pack whole = madd(steps, 1.0, round_magic) - round_magic;
  whole = select(steps < whole, whole - 1.0, whole);
  // abs(t) / step was rounded: corrected by the remainder.
  const Pack rest = nmadd(whole, step, abs(t));
  whole = select(Pack(step) <= rest, whole + 1.0, select(rest < 0.0, whole - 1.0, whole));
  const Pack target = copy_sign(whole * step, t);
  const Pack drift = at(b.drift, first);

  Pack time = at(node.time, first);
  Pack lambda = at(node.lambda, first), n = at(node.n, first);
  Slopes d = {at(node.n_dot, first), at(node.n_ddot, first)};
  if (bits(time == target) != all_lanes) [[unlikely]] {
    const Mask usable = (Pack(0.0) < time * target) & (abs(time) <= abs(target));
    lambda = select(usable, lambda, at(b.lambda0, first));
    n = select(usable, n, at(b.n0, first));
    time = select(usable, time, 0.0);
    const Slopes at_epoch = slopes(b, first, lambda, n, time);
    d = {select(usable, d.n_dot, at_epoch.n_dot), select(usable, d.n_ddot, at_epoch.n_ddot)};
    const Pack delta = copy_sign(step, t);
    for (;;) {
      const Mask on = abs(time) < abs(target);
      if (!any(on)) break;
      const Pack l1 = madd(d.n_dot, 0.5 * step * step, madd(n + drift, delta, lambda));
      const Pack n1 = madd(d.n_ddot, 0.5 * step * step, madd(d.n_dot, delta, n));
      lambda = select(on, l1, lambda);
      n = select(on, n1, n);
      time = select(on, time + delta, time);
      const Slopes d1 = slopes(b, first, lambda, n, time);
      d = {select(on, d1.n_dot, d.n_dot), select(on, d1.n_ddot, d.n_ddot)};
    }
    store(node.time.lane + first, time);
    store(node.lambda.lane + first, lambda);
    store(node.n.lane + first, n);
    store(node.n_dot.lane + first, d.n_dot);
    store(node.n_ddot.lane + first, d.n_ddot);
  }
  const Pack ft = t - time;
  const Pack half_ft2 = ft * ft * 0.5;
  return {madd(d.n_dot, half_ft2, madd(n + drift, ft, lambda)),
          madd(d.n_ddot, half_ft2, madd(d.n_dot, ft, n))};
}

/// q^(-1/3) for q around 1.
DMISE_INLINE Pack inverse_cube_root(Pack q) {
  const Pack d = q - 1.0;
  Pack v = madd(madd(madd(d, -14.0 / 81.0, 2.0 / 9.0), d, -1.0 / 3.0), d, 1.0);
  const Mask far = ~(abs(d) <= 0.05);
  if (any(far)) [[unlikely]] {
    alignas(64) double lanes[pack_lanes];
    store(lanes, select(far & (Pack(0.0) < q), q, 1.0));
    for (double& x : lanes) x = 1.0 / cbrt(x);
    v = select(far, load(lanes), v);
  }
  for (int k = 0; k < 2; ++k) v = madd(v, nmadd(q * v, v * v, 1.0) * (1.0 / 3.0), v);
  return v;
}

struct Periodic {
  Pack e, i, l, gh, h;
};

DMISE_INLINE Periodic body_periodics(const BodyTerms<Lanes>& b, int first, Pack t, double rate,
                                     double eccentricity) {
  const Pack mean = madd(t, rate, at(b.phase, first));
  const SinCos f = sin_cos(madd(sin_cos(mean).sin, 2.0 * eccentricity, mean));
  const Pack half = f.sin * 0.5;
  const Pack f2 = madd(half, f.sin, -0.25);
  const Pack f3 = Pack(0.0) - half * f.cos;
  return {madd(at(b.e2, first), f2, at(b.e3, first) * f3),
          madd(at(b.i2, first), f2, at(b.i3, first) * f3),
          madd(at(b.l4, first), f.sin, madd(at(b.l2, first), f2, at(b.l3, first) * f3)),
          madd(at(b.gh4, first), f.sin, madd(at(b.gh2, first), f2, at(b.gh3, first) * f3)),
          madd(at(b.h2, first), f2, at(b.h3, first) * f3)};
}

DMISE_INLINE States deep_states(const DeepBlock& block, int first, Pack t, const Ahead& ahead) {
  t = within_span(t);
  const DeepTerms<Lanes>& b = *block.terms;
  const SecularTerms<Lanes>& s = b.secular;
  const Pack t2 = t * t;
  Pack argp = madd(at(s.argp_dot, first), t, at(s.argp, first));
  Pack node = madd(at(s.node_t2, first), t2, madd(at(s.node_dot, first), t, at(s.node, first)));
  const Pack a = nmadd(at(s.a_t, first), t, 1.0);
  const Pack sqrt_a = at(s.sqrt_a0, first) * a;

  Mean m;
  m.ahead = ahead;
  fetch(ahead, 0);
  m.a_m = sqrt_a * sqrt_a * earth_radius_m;
  m.inv_sqrt_a = Pack(1.0) / abs(sqrt_a);
  m.code2 = Pack(1.0) < 0.0;
  Pack mean_anomaly;
  if (block.day || block.half_day) {
    Resonant r;
    Pack ratio;
    if (block.day) {
      r = integrate(*block.day, first, t, *block.node);
      ratio = r.n / at(block.day->n0, first);
      const Pack gst = madd(t, sidereal_rate_rad_per_min, at(block.day->gst, first));
      mean_anomaly = r.lambda - node - argp + gst;
    } else {
      r = integrate(*block.half_day, first, t, *block.node);
      ratio = r.n / at(block.half_day->n0, first);
      const Pack gst = madd(t, sidereal_rate_rad_per_min, at(block.half_day->gst, first));
      mean_anomaly = r.lambda - node * 2.0 + gst * 2.0;
    }
    m.code2 = r.n <= 0.0;
    const Pack v = inverse_cube_root(ratio);
    m.a_m = m.a_m * v * v;
    m.inv_sqrt_a = m.inv_sqrt_a * (ratio * v * v);
  } else {
    mean_anomaly = madd(at(s.m_dot, first), t, at(s.m, first));
  }
  m.inv_a = m.inv_sqrt_a * m.inv_sqrt_a;
  m.farthest_m = at(s.farthest_m, first);
  mean_anomaly = madd(at(s.l_t2, first), t2, mean_anomaly);
  const Pack e = madd(at(s.e_dot, first), t, at(s.e, first));
  m.code1 = eccentricity_fails(e);

  const Periodic sun = body_periodics(b.sun, first, t, sun_rate, sun_eccentricity);
  const Periodic moon = body_periodics(b.moon, first, t, moon_rate, moon_eccentricity);
  fetch(ahead, 1);
  const Pack d_i = sun.i + moon.i;
  Pack h = sun.h + moon.h;
  Pack gh = sun.gh + moon.gh;
  m.e = max(e, 1e-6) + (sun.e + moon.e);
  m.code3 = (m.e < 0.0) | (Pack(1.0) < m.e);
  const Pack i = madd(at(b.i_dot, first), t, at(b.i, first)) + d_i;
  SinCos inc = sin_cos(i);
  mean_anomaly = mean_anomaly + (sun.l + moon.l);

  const Mask low = ~(Pack(0.2) <= i);
  const Pack h_direct = h / inc.sin;
  Pack d_argp = nmadd(inc.cos, h_direct, gh);
  Pack d_node = h_direct;
  if (any(low)) [[unlikely]] {
    // Lyddane: the node turns by the angle between (sin i sin node, sin i cos node) and the same
    // with h and d_i added. The node enters by its value, within a turn of zero and signed.
    const Pack turns = abs(node) * (0.5 * inv_pi);
    Pack whole = madd(turns, 1.0, round_magic) - round_magic;
    whole = select(turns < whole, whole - 1.0, whole);
    const Pack wrapped = minus_k_pi(node, copy_sign(whole + whole, node));
    const Pack turn = angle_of(h, madd(d_i, inc.cos, inc.sin));
    d_node = select(low, turn, d_node);
    d_argp = select(low, nmadd(inc.cos, turn, nmadd(d_i * inc.sin, wrapped, gh)), d_argp);
  }
  argp = argp + d_argp;
  node = node + d_node;
  const Mask negative = i < 0.0;
  if (any(negative)) [[unlikely]] {
    inc.sin = select(negative, Pack(0.0) - inc.sin, inc.sin);
    node = select(negative, node + 3.14159265358979323846, node);
    argp = select(negative, argp - 3.14159265358979323846, argp);
  }
  m.argp = argp;
  m.longitude = mean_anomaly + argp;
  m.node = sin_cos(node);
  m.sin_i = inc.sin;
  m.cos_i = inc.cos;
  const Pack one_cos = Pack(1.0) + inc.cos;
  m.long_period = inc.sin * (-0.25 * j3_over_j2) * madd(inc.cos, 5.0, 3.0) /
                  select(Pack(1.5e-12) < abs(one_cos), one_cos, 1.5e-12);
  switch (block.shape) {
    case Shape::circle:
      return finish_each<Shape::circle>(m);
    case Shape::oval:
      return finish_each<Shape::oval>(m);
    case Shape::any:
      break;
  }
  return finish_each<Shape::any>(m);
}

void deep_block(const DeepBlock& block, const Lanes& t, BlockStates& out) {
  for (int first = 0; first < block_lanes; first += pack_lanes)
    put(deep_states(block, first, at(t, first), {}), first, out);
}

void deep_block_at(const DeepBlock& block, const std::uint32_t* index, std::size_t objects,
                   const Instants& times, const Output& out) {
  constexpr std::size_t packs = block_lanes / pack_lanes;
  const BlockPlaces places = block_places(index, objects);
  for (std::size_t k = 0; k < times.count; ++k) {
    const Output to = of_time(out, k);
    for (std::size_t pack = 0; pack < packs; ++pack) {
      const int first = int(pack) * pack_lanes;
      const Pack t = minutes(block.terms->secular, first, times.at[k].jd1, times.at[k].jd2);
      const Ahead ahead =
          block.next ? part_of(block.next, k * packs + pack, times.count * packs) : Ahead{};
      put(deep_states(block, first, t, ahead), first, places, to);
    }
  }
}

}  // namespace
}  // namespace dmise::sgp4
