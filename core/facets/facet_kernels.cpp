#include "core/facets/facet_kernels.h"

#include "core/base/numeric/lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

constexpr double four_pi = 12.566370614359172;
constexpr double min_cosine = 0.02;  // min_cos_out of core/materials/brdf.h

DMISE_INLINE F64 along(const FacetArrays& f, std::size_t i, const double* direction) {
  return load<F64>(f.normal_x + i) * direction[0] + load<F64>(f.normal_y + i) * direction[1] +
         load<F64>(f.normal_z + i) * direction[2];
}

DMISE_INLINE F64 light(const FacetArrays& f, std::size_t i, const FacetDirections& at) {
  const F64 zero = splat(0.0), one = splat(1.0);
  const F64 in = along(f, i, at.sun), out = along(f, i, at.viewer);
  const F64 in2 = in * in, out2 = out * out;
  const F64 b2 = load<F64>(f.grazing2 + i), e2 = load<F64>(f.lobe2 + i);
  const F64 falloff_in = in2 / (in2 + b2 * (one - in2));
  const F64 falloff_out = out2 / (out2 + b2 * (one - out2));
  const F64 sum = in + out;
  const F64 half2 = min(one, sum * sum * at.inverse_half2);
  const F64 root = e2 * half2 + (one - half2);
  const F64 d = one - e2, d_in = d * in;
  const F64 norm = d_in + (e2 + e2 + d_in * d_in) / sqrt(d_in * d_in + 4.0 * e2);  // 2 e^2 H
  const F64 specular = max(zero, one - load<F64>(f.taken + i) * falloff_in);
  const F64 fade = min(one, out * (1.0 / min_cosine));
  const F64 reflected = load<F64>(f.diffuse + i) * falloff_in * falloff_out * out +
                        specular * fade * (e2 + e2) / (four_pi * norm * root * root);
  const F64 all = load<F64>(f.area_m2 + i) * in * reflected;
  const F64 least = splat(1e-100);  // its square is not 0
  return in > least && out > least ? all : zero;
}

}  // namespace

double facet_sum(const FacetArrays& facets, const FacetDirections& at) {
  // Eight partial sums at every vector width: the same bytes on every instruction set.
  constexpr int vectors = 8 / wide_lanes;
  F64 sums[vectors] = {};
  for (std::size_t i = 0; i < facets.count; i += 8)
    for (int k = 0; k < vectors; ++k) sums[k] += light(facets, i + std::size_t(k) * wide_lanes, at);
  double lane[8];
  for (int k = 0; k < vectors; ++k) store(lane + k * wide_lanes, sums[k]);
  double total = 0.0;
  for (const double s : lane) total += s;
  return total;
}

}  // namespace dmise::DMISE_SIMD
