#include "core/facets/facet_light.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/facets/facet_kernels.h"

namespace dmise {
namespace {

double sum_of(const FacetSet& set, const double* area_m2, const Vec<Body>& sun,
              const Vec<Body>& viewer, SimdLevel level) {
  const Vec<Body> half = sun + viewer;
  std::vector<double> flat_m2;  // without facets that have a height map
  const double* const free_m2 = area_m2;
  if (!set.bumps.empty()) {
    flat_m2.assign(area_m2, area_m2 + set.area_m2.size());
    for (const auto& b : set.bumps) flat_m2[b.facet] = 0.0;
    area_m2 = flat_m2.data();
  }
  const FacetArrays arrays{
      set.area_m2.size(), set.normal_x.data(), set.normal_y.data(), set.normal_z.data(), area_m2,
      set.diffuse.data(), set.taken.data(),    set.grazing2.data(), set.lobe2.data()};
  const FacetDirections at{{sun.x, sun.y, sun.z},
                           {viewer.x, viewer.y, viewer.z},
                           1.0 / std::max(dot(half, half), 1e-300)};
  const auto kernel = level == SimdLevel::avx512 ? avx512::facet_sum
                      : level == SimdLevel::avx2 ? avx2::facet_sum
                                                 : sse2::facet_sum;
  double sum = kernel(arrays, at);
  const double cos_phase = dot(sun, viewer);
  for (const auto& lobe : set.lobes) {
    const Vec<Body> normal = set.normal(lobe.facet);
    const double in = dot(normal, sun), out = dot(normal, viewer);
    const double mirror = std::min(1.0, 2.0 * in * out - cos_phase);
    if (in > 0.0 && out > 0.0 && mirror > 0.0)
      sum += area_m2[lobe.facet] * in * out * lobe.scale * std::pow(mirror, lobe.exponent);
  }
  for (const auto& b : set.bumps) {
    const double out = dot(set.normal(b.facet), viewer);
    if (!(out > 0.0 && dot(set.normal(b.facet), sun) > 0.0)) continue;
    for (std::size_t i = b.begin; i < b.end; ++i) {
      const auto& bump = set.bump_normals[i];
      const double in = dot(bump.normal, sun);
      const double seen = std::max(0.0, dot(bump.normal, viewer));
      if (!(in > 0.0)) continue;
      const double mirror = std::clamp(2.0 * in * seen - cos_phase, 0.0, 1.0);
      const double lobe = mirror > 0.0 ? b.phong_scale * std::pow(mirror, b.exponent) : 0.0;
      sum += free_m2[b.facet] * out * bump.share * in * (bump.diffuse + lobe);
    }
  }
  return sum;
}

}  // namespace

FacetLight::FacetLight(Mesh mesh, const Band& band, bool emits)
    : mesh_(std::move(mesh)), set_(facet_set(mesh_, band)), convex_(is_convex(mesh_)) {
  if (!emits) std::fill(set_.emitted.begin(), set_.emitted.end(), 0.0);
}

FacetLight FacetLight::turned(const HingedPanel& panel, const Vec<Body>& to_sun) const {
  const Rotation<Body, Body> rotation = panel_rotation(panel.axes, to_sun);
  FacetLight light = *this;
  turn_panel(light.mesh_, panel.hinge_m, rotation);
  FacetSet& set = light.set_;
  const auto& triangles = mesh_.triangles;
  for (std::size_t f = 0; f < set.count; ++f) {
    if (!triangles[f].panel) continue;
    const Vec<Body> normal = rotation * set.normal(f);
    set.normal_x[f] = normal.x;
    set.normal_y[f] = normal.y;
    set.normal_z[f] = normal.z;
  }
  for (const auto& b : set.bumps)
    for (std::size_t i = b.begin; i < b.end && triangles[b.facet].panel; ++i)
      set.bump_normals[i].normal = rotation * set.bump_normals[i].normal;
  light.convex_ = convex_ && std::ranges::all_of(triangles, &Mesh::Triangle::panel);
  return light;
}

std::vector<double> FacetLight::free_area_m2(const FacetShadow* sun,
                                             const FacetShadow& viewer) const {
  std::vector<double> area = set_.area_m2;
  std::vector<FacetPiece> pieces;
  for (std::size_t f = 0; f < set_.count; ++f) {
    if (viewer.cosine(f) <= 0.0 || (sun && sun->cosine(f) <= 0.0)) continue;
    pieces.assign(1, FacetPiece::whole());
    if (sun) sun->cut(f, pieces);
    if (!pieces.empty()) viewer.cut(f, pieces);
    double share = 0.0;
    for (const auto& piece : pieces) share += area_share(piece);
    area[f] *= std::clamp(share, 0.0, 1.0);
  }
  return area;
}

double FacetLight::reflected_m2_per_sr(const Vec<Body>& to_sun, const Vec<Body>& to_viewer,
                                       SimdLevel level) const {
  const LightSource sun{to_sun};
  return reflected_m2_per_sr(std::span(&sun, 1), to_viewer, level);
}

double FacetLight::reflected_m2_per_sr(std::span<const LightSource> sources,
                                       const Vec<Body>& to_viewer, SimdLevel level) const {
  std::optional<FacetShadow> viewer;
  if (!convex_) viewer.emplace(mesh_, to_viewer);
  std::vector<double> free_m2;
  double sum = 0.0;
  for (const auto& source : sources) {
    if (viewer) {
      const FacetShadow sun(mesh_, source.to_source);
      free_m2 = free_area_m2(&sun, *viewer);
    }
    const auto& area = viewer ? free_m2 : set_.area_m2;
    sum += source.share * sum_of(set_, area.data(), source.to_source, to_viewer, level);
  }
  return sum;
}

double FacetLight::emitted_photons_per_s_sr(const Vec<Body>& to_viewer) const {
  const double most = *std::max_element(set_.emitted.begin(), set_.emitted.end());
  if (!(most > 0.0)) return 0.0;
  std::vector<double> hidden;
  if (!convex_) hidden = free_area_m2(nullptr, FacetShadow(mesh_, to_viewer));
  const auto& area = convex_ ? set_.area_m2 : hidden;
  double sum = 0.0;
  for (std::size_t f = 0; f < set_.count; ++f)
    sum += set_.emitted[f] * area[f] * std::max(0.0, dot(set_.normal(f), to_viewer));
  return sum;
}

}  // namespace dmise
