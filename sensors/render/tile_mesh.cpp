#include "sensors/render/tile_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/base/units.h"
#include "core/materials/brdf.h"
#include "sensors/render/clip_space.h"
#include "sensors/render/sample_count.h"

namespace dmise {
namespace {

TileMesh::Bounds bounds_of(const std::array<TileVertex, 3>& v, const TileCamera& camera,
                           double near_m) {
  float x0 = 1e30f, y0 = 1e30f, x1 = -1e30f, y1 = -1e30f;
  for (const auto& corner : v) {
    if (!(corner.clip[3] > near_m)) return {-1e30f, -1e30f, 1e30f, 1e30f};
    const float x = (corner.clip[0] / corner.clip[3] + 1) * 0.5f * float(camera.columns) - 0.5f;
    const float y = (corner.clip[1] / corner.clip[3] + 1) * 0.5f * float(camera.rows) - 0.5f;
    x0 = std::min(x0, x);
    y0 = std::min(y0, y);
    x1 = std::max(x1, x);
    y1 = std::max(y1, y);
  }
  return {x0, y0, x1, y1};
}

class Builder {
 public:
  Builder(const TileScene& scene, const LightSource& source, std::size_t first_band, bool emission,
          bool visible)
      : scene_(scene),
        source_(source),
        first_(first_band),
        bands_(std::min<std::size_t>(3, scene.bands.size() - first_band)),
        emission_(emission),
        specks_(visible),
        clip_(scene) {
    for (std::size_t k = 0; k < bands_; ++k) {
      lobe_of_[k].assign(scene.mesh->triangles.size(), -1);
      const auto& lobes = facets(k).lobes;
      for (std::size_t i = 0; i < lobes.size(); ++i) lobe_of_[k][lobes[i].facet] = int(i);
    }
  }

  TileMesh build(const LitPieces& lit) {
    const auto& mesh = *scene_.mesh;
    place_.resize(mesh.vertex_m.size());
    for (std::size_t i = 0; i < place_.size(); ++i) place_[i] = clip_.place(mesh.vertex_m[i]);
    const auto for_facing = [&](auto&& work) {
      for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
        if (faces_camera(f)) work(f);
    };
    for_facing([&](std::size_t f) {
      if (lit.state[f] == LitPieces::partly) add_whole(f, false);
    });
    out_.underlays = out_.bounds.size();
    for_facing([&](std::size_t f) {
      if (lit.state[f] == LitPieces::partly)
        add_parts(f, std::span(lit.pieces).subspan(lit.begin[f], lit.begin[f + 1] - lit.begin[f]));
      else
        add_whole(f, lit.state[f] == LitPieces::lit);
    });
    return std::move(out_);
  }

 private:
  const FacetSet& facets(std::size_t k) const { return *scene_.bands[first_ + k].facets; }

  Vec<CameraFrame> corner(std::size_t facet, int i) const {
    return place_[scene_.mesh->triangles[facet].corner[std::size_t(i)]];
  }

  bool faces_camera(std::size_t f) const {
    const Vec<CameraFrame> normal = scene_.camera_from_body * facets(0).normal(f);
    return dot(normal, corner(f, 0)) < 0.0;
  }

  /// Everything of a corner that does not depend on its place.
  TileVertex surface(std::size_t f, bool lit) const {
    TileVertex v{};
    const Vec<Body> normal = facets(0).normal(f);
    const Vec<CameraFrame> n = scene_.camera_from_body * normal;
    v.normal[0] = float(n.x);
    v.normal[1] = float(n.y);
    v.normal[2] = float(n.z);
    v.diffuse[3] = float(facets(0).grazing2[f]);
    v.specular[3] = float(facets(0).lobe2[f]);
    v.emitted[3] = -1.0f;
    const double in = dot(normal, source_.to_source);
    for (std::size_t k = 0; k < bands_; ++k) {
      const FacetSet& set = facets(k);
      if (emission_) v.emitted[k] = float(set.emitted[f]);
      if (!lit || !(in > 0.0)) continue;
      const double irradiance = scene_.bands[first_ + k].sun_irradiance * source_.share * in;
      const double falloff = sandford_robertson_falloff(in, std::sqrt(set.grazing2[f]));
      v.diffuse[k] = float(irradiance * set.diffuse[f] * falloff);
      if (const int lobe = lobe_of_[k][f]; lobe >= 0) {
        v.specular[k] = float(irradiance * set.lobes[std::size_t(lobe)].scale);
        v.emitted[3] = float(set.lobes[std::size_t(lobe)].exponent);
      } else {
        const double norm = sandford_robertson_lobe_norm(in, std::sqrt(set.lobe2[f]));
        v.specular[k] =
            float(irradiance * std::max(0.0, 1.0 - set.taken[f] * falloff) / (4.0 * pi * norm));
      }
    }
    return v;
  }

  void add(const TileVertex& surface, const std::array<Vec<CameraFrame>, 3>& p) {
    std::array<TileVertex, 3> v{surface, surface, surface};
    for (std::size_t i = 0; i < 3; ++i) clip_.put(p[i], v[i]);
    out_.bounds.push_back(bounds_of(v, scene_.camera, clip_.near_m()));
    out_.vertices.insert(out_.vertices.end(), v.begin(), v.end());
  }

  void scale(TileVertex& look, double factor) const {
    for (std::size_t k = 0; k < bands_; ++k)
      for (float* light : {look.diffuse, look.specular, look.emitted})
        light[k] = float(light[k] * factor);
  }

  void add_whole(std::size_t f, bool lit) {
    const SampleCount::Triangle p{corner(f, 0), corner(f, 1), corner(f, 2)};
    TileVertex look = surface(f, lit);
    if (lit) {
      SampleCount samples(scene_.camera, scene_.oversampling);
      samples.add(p);
      if (specks_ && samples.sparse()) {
        add_speck(look, p, samples.area());
        look = surface(f, false);
      } else if (samples.narrow()) {
        scale(look, samples.correction());
      }
    }
    add(look, p);
  }

  void add_parts(std::size_t f, std::span<const FacetPiece> pieces) {
    const Vec<CameraFrame> o = corner(f, 0), e1 = corner(f, 1) - o, e2 = corner(f, 2) - o;
    std::vector<SampleCount::Triangle> parts;
    SampleCount samples(scene_.camera, scene_.oversampling);
    for (const auto& piece : pieces) {
      const auto at = [&](int i) {
        return o + e1 * piece.corner[std::size_t(i)].s + e2 * piece.corner[std::size_t(i)].t;
      };
      for (int i = 1; i + 1 < piece.corners; ++i) {
        parts.push_back({at(0), at(i), at(i + 1)});
        samples.add(parts.back());
      }
    }
    TileVertex look = surface(f, true);
    if (specks_ && samples.sparse()) {  // on the dark underlay
      if (!parts.empty()) add_speck(look, parts[0], samples.area());
      return;
    }
    scale(look, samples.correction());
    for (const auto& part : parts) add(look, part);
  }

  /// What the shader makes of a look at the middle of a triangle, times its area, less its own
  /// emission, which stays with the samples.
  void add_speck(const TileVertex& look, const SampleCount::Triangle& p, double area_samples) {
    const Vec<CameraFrame> middle = (p[0] + p[1] + p[2]) / 3.0;
    const Vec<CameraFrame> n{look.normal[0], look.normal[1], look.normal[2]};
    const Vec<CameraFrame> view = unit(-middle);
    const Vec<CameraFrame> source = scene_.camera_from_body * source_.to_source;
    const double c = dot(n, view);
    if (!(c > 0.0)) return;
    const Vec<CameraFrame> h = view + source;
    const double cos2 = std::min(1.0, dot(n, h) * dot(n, h) / std::max(dot(h, h), 1e-30));
    const double root = look.specular[3] * cos2 + (1.0 - cos2);
    const double mirror = std::clamp(2.0 * dot(n, source) * c - dot(view, source), 0.0, 1.0);
    const double lobe = look.emitted[3] < 0.0f ? 1.0 / (root * root * std::max(c, least_cos_out))
                        : mirror > 0.0         ? std::pow(mirror, double(look.emitted[3]))
                                               : 0.0;
    const double falloff = c * c / (c * c + look.diffuse[3] * (1.0 - c * c));
    const double pixels = area_samples / (scene_.oversampling * double(scene_.oversampling));
    TileMesh::Speck speck{};
    const TileCamera& camera = scene_.camera;
    speck.x_px = float(camera.principal_x_px - camera.left + camera.focal_px * middle.x / middle.z);
    speck.y_px = float(camera.principal_y_px - camera.top + camera.focal_px * middle.y / middle.z);
    for (std::size_t k = 0; k < bands_; ++k)
      speck.light[k] = float((look.diffuse[k] * falloff + look.specular[k] * lobe) * pixels);
    out_.specks.push_back(speck);
  }

  const TileScene& scene_;
  const LightSource& source_;
  std::size_t first_, bands_;
  bool emission_;
  bool specks_;
  ClipSpace clip_;
  std::array<std::vector<int>, 3> lobe_of_;
  std::vector<Vec<CameraFrame>> place_;
  TileMesh out_;
};

}  // namespace

LitPieces lit_pieces(const Mesh& mesh, const Vec<Body>& to_source, bool convex,
                     const FacetShadow* viewer) {
  const std::size_t count = mesh.triangles.size();
  LitPieces lit;
  lit.state.assign(count, LitPieces::dark);
  lit.begin.assign(count + 1, 0);
  lit.only_visible = convex || viewer;
  const FacetShadow shadow(mesh, to_source);
  std::vector<FacetPiece> pieces;
  for (std::size_t f = 0; f < count; ++f) {
    if (shadow.cosine(f) > 0.0) {
      lit.state[f] = LitPieces::lit;
      const bool shaded = !convex && shadow.may_be_hidden(f);
      const bool covered = viewer && viewer->cosine(f) > 0.0 && viewer->may_be_hidden(f);
      if (shaded || covered) {
        pieces.assign(1, FacetPiece::whole());
        if (shaded) shadow.cut(f, pieces);
        if (covered && !pieces.empty()) viewer->cut(f, pieces);
        double share = 0.0;
        for (const auto& piece : pieces) share += area_share(piece);
        lit.state[f] = share > 1.0 - 1e-9 ? LitPieces::lit
                       : share < 1e-9     ? LitPieces::dark
                                          : LitPieces::partly;
        if (lit.state[f] == LitPieces::partly)
          lit.pieces.insert(lit.pieces.end(), pieces.begin(), pieces.end());
      }
    }
    lit.begin[f + 1] = std::uint32_t(lit.pieces.size());
  }
  return lit;
}

TileMesh tile_mesh(const TileScene& scene, const LightSource& source, const LitPieces& lit,
                   std::size_t first_band, bool with_emission) {
  return Builder(scene, source, first_band, with_emission, lit.only_visible).build(lit);
}

}  // namespace dmise
