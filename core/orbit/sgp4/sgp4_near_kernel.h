// Near-Earth objects on packs. Included only by sgp4_kernel.h.
#pragma once
#include "core/orbit/sgp4/sgp4_kernels.h"
#include "core/orbit/sgp4/sgp4_terms.h"
#include "core/orbit/sgp4/sgp4_trig.h"

namespace dmise::sgp4 {
namespace {

template <Shape shape>
DMISE_INLINE States near_states(const NearTerms<Lanes>& b, int first, Pack t, const Ahead& ahead) {
  t = within_span(t);
  const SecularTerms<Lanes>& s = b.secular;
  const Pack t2 = t * t;
  const Pack m0 = madd(at(s.m_dot, first), t, at(s.m, first));
  const Pack argp0 = madd(at(s.argp_dot, first), t, at(s.argp, first));

  Mean m;
  m.ahead = ahead;
  fetch(ahead, 0);
  m.node =
      sin_cos(madd(at(s.node_t2, first), t2, madd(at(s.node_dot, first), t, at(s.node, first))));
  const Pack c = madd(at(b.eta, first), coarse_cos(m0), 1.0);
  fetch(ahead, 1);
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
  const Pack sqrt_a = at(s.sqrt_a0, first) * a;
  m.a_m = sqrt_a * sqrt_a * earth_radius_m;
  m.inv_sqrt_a = Pack(1.0) / abs(sqrt_a);
  m.inv_a = m.inv_sqrt_a * m.inv_sqrt_a;
  m.farthest_m = at(s.farthest_m, first);
  return finish_each<shape>(m);
}

template <Shape shape>
void near_blocks_of(const NearTerms<Lanes>* blocks, const std::uint32_t* index, std::size_t objects,
                    const Instants& times, const Output& out) {
  constexpr std::size_t packs = block_lanes / pack_lanes;
  for (std::size_t done = 0; done < objects; done += block_lanes, ++blocks) {
    const BlockPlaces places = block_places(index + done, objects - done);
    for (std::size_t k = 0; k < times.count; ++k) {
      const Output to = of_time(out, k);
      for (std::size_t pack = 0; pack < packs; ++pack) {
        const int first = int(pack) * pack_lanes;
        const Pack t = minutes(blocks->secular, first, times.at[k].jd1, times.at[k].jd2);
        const Ahead ahead = part_of(blocks + 1, k * packs + pack, times.count * packs);
        put(near_states<shape>(*blocks, first, t, ahead), first, places, to);
      }
    }
  }
}

void near_blocks(const NearTerms<Lanes>* blocks, const std::uint32_t* index, std::size_t objects,
                 Shape shape, const Instants& times, const Output& out) {
  switch (shape) {
    case Shape::circle:
      return near_blocks_of<Shape::circle>(blocks, index, objects, times, out);
    case Shape::oval:
      return near_blocks_of<Shape::oval>(blocks, index, objects, times, out);
    case Shape::any:
      return near_blocks_of<Shape::any>(blocks, index, objects, times, out);
  }
}

template <Shape shape>
void near_block_of(const NearTerms<Lanes>& block, const Lanes& t, BlockStates& out) {
  for (int first = 0; first < block_lanes; first += pack_lanes)
    put(near_states<shape>(block, first, at(t, first), {}), first, out);
}

void near_block(const NearTerms<Lanes>& block, Shape shape, const Lanes& t, BlockStates& out) {
  switch (shape) {
    case Shape::circle:
      return near_block_of<Shape::circle>(block, t, out);
    case Shape::oval:
      return near_block_of<Shape::oval>(block, t, out);
    case Shape::any:
      return near_block_of<Shape::any>(block, t, out);
  }
}

}  // namespace
}  // namespace dmise::sgp4
