#include "sensors/render/tile_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/base/units.h"
#include "core/materials/brdf.h"
#include "core/materials/texture.h"
#include "sensors/render/clip_space.h"
#include "sensors/render/sample_count.h"

namespace dmise {
namespace {

TileMesh::Bounds bounds_of(const std::array<TileVertex, 3>& v, const TileCamera& camera,
                           double near_m) {
  const glm::vec2 size_px(camera.columns, camera.rows);
  glm::vec2 least(1e30f), most(-1e30f);
  for (const auto& corner : v) {
    if (!(corner.clip.w > near_m)) return {-1e30f, -1e30f, 1e30f, 1e30f};
    const glm::vec2 at = (glm::vec2(corner.clip) / corner.clip.w + 1.0f) * 0.5f * size_px - 0.5f;
    least = glm::min(least, at);
    most = glm::max(most, at);
  }
  return {least.x, least.y, most.x, most.y};
}

class Builder {
 public:
  Builder(const TileScene& scene, const LightSource& source, std::size_t first_band, bool emission,
          const LitPieces& lit)
      : scene_(scene),
        source_(source),
        first_(first_band),
        bands_(int(std::min<std::size_t>(3, scene.bands.size() - first_band))),
        emission_(emission),
        specks_(lit.only_visible),
        emission_specks_(emission && lit.convex),
        camera_from_body_(glm_of(scene.camera_from_body)),
        clip_(scene) {
    for (int k = 0; k < bands_; ++k) {
      auto& lobe_of = lobe_of_[std::size_t(k)];
      lobe_of.assign(scene.mesh->triangles.size(), -1);
      const auto& lobes = facets(k).lobes;
      for (std::size_t i = 0; i < lobes.size(); ++i) lobe_of[lobes[i].facet] = int(i);
    }
    for (const auto& m : scene.mesh->materials)
      if (m.colour_map || m.slope_map) textured_ = true;
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
  const FacetSet& facets(int k) const { return *scene_.bands[first_ + std::size_t(k)].facets; }

  glm::dvec3 corner(std::size_t facet, int i) const {
    return place_[scene_.mesh->triangles[facet].corner[std::size_t(i)]];
  }

  glm::dvec3 normal_of(std::size_t f) const {
    return camera_from_body_ * glm_of(facets(0).normal(f));
  }

  bool faces_camera(std::size_t f) const { return glm::dot(normal_of(f), corner(f, 0)) < 0.0; }

  /// Attributes of a corner that do not depend on its position.
  TileVertex surface(std::size_t f, bool lit) const {
    TileVertex v{};
    v.normal = normal_of(f);
    v.diffuse.w = float(facets(0).grazing2[f]);
    v.specular.w = float(facets(0).lobe2[f]);
    v.emitted.w = -1.0f;
    const double in = dot(facets(0).normal(f), source_.to_source);
    for (int k = 0; k < bands_; ++k) {
      const FacetSet& set = facets(k);
      if (emission_) v.emitted[k] = float(set.emitted[f]);
      if (!lit || !(in > 0.0)) continue;
      const double irradiance =
          scene_.bands[first_ + std::size_t(k)].sun_irradiance * source_.share * in;
      const double falloff = sandford_robertson_falloff(in, std::sqrt(set.grazing2[f]));
      v.diffuse[k] = float(irradiance * set.diffuse[f] * falloff);
      if (const int lobe = lobe_of_[std::size_t(k)][f]; lobe >= 0) {
        v.specular[k] = float(irradiance * set.lobes[std::size_t(lobe)].scale);
        v.emitted.w = float(set.lobes[std::size_t(lobe)].exponent);
      } else {
        const double norm = sandford_robertson_lobe_norm(in, std::sqrt(set.lobe2[f]));
        v.specular[k] =
            float(irradiance * std::max(0.0, 1.0 - set.taken[f] * falloff) / (4.0 * pi * norm));
      }
    }
    return v;
  }

  using Places = std::array<FacetPiece::Point, 3>;  // corners, in coordinates of their facet

  void add(const TileVertex& surface, std::size_t f, const SampleCount::Triangle& p,
           const Places& at) {
    std::array<TileVertex, 3> v{surface, surface, surface};
    for (std::size_t i = 0; i < 3; ++i) clip_.put(p[i], v[i]);
    if (textured_) {
      add_texture(f, at);
      for (int k = 0; k < bands_; ++k)
        if (const float mean = facets(k).colour_mean[f]; mean > 0.0f)
          for (auto& corner : v) corner.diffuse[k] /= mean;
    }
    out_.bounds.push_back(bounds_of(v, scene_.camera, clip_.near_m()));
    out_.vertices.insert(out_.vertices.end(), v.begin(), v.end());
  }

  void add_texture(std::size_t f, const Places& at) {
    const Mesh& mesh = *scene_.mesh;
    const auto& triangle = mesh.triangles[f];
    const Material& m = mesh.materials[triangle.material];
    std::array<TextureVertex, 3> v{};
    const auto places = [&](const Texture& texture) {
      std::array<TexturePlace, 3> of;
      for (std::size_t i = 0; i < 3; ++i) of[i] = texture.of(triangle.place[i]);
      return of;
    };
    const auto put = [&](const Texture& texture, glm::length_t first) {
      const auto of = places(texture);
      for (std::size_t i = 0; i < 3; ++i) {
        const auto s = float(at[i].s), t = float(at[i].t);
        v[i].place[first] = of[0].u + s * (of[1].u - of[0].u) + t * (of[2].u - of[0].u);
        v[i].place[first + 1] = of[0].v + s * (of[1].v - of[0].v) + t * (of[2].v - of[0].v);
      }
    };
    if (m.colour_map) put(*m.colour_map, 0);
    if (m.slope_map) {
      put(*m.slope_map, 2);
      std::array<Vec<Body>, 3> corner_m;
      for (std::size_t i = 0; i < 3; ++i) corner_m[i] = mesh.vertex_m[triangle.corner[i]];
      const auto gradient = place_gradients(corner_m, places(*m.slope_map));
      for (auto& corner : v) {
        corner.slope_u = camera_from_body_ * glm_of(gradient[0] * m.height_m);
        corner.slope_v = camera_from_body_ * glm_of(gradient[1] * m.height_m);
      }
    }
    out_.material.push_back(triangle.material);
    out_.texture.insert(out_.texture.end(), v.begin(), v.end());
  }

  void scale(TileVertex& look, double factor) const {
    for (int k = 0; k < bands_; ++k)
      for (glm::vec4* light : {&look.diffuse, &look.specular, &look.emitted})
        (*light)[k] = float((*light)[k] * factor);
  }

  void add_whole(std::size_t f, bool lit) {
    const SampleCount::Triangle p{corner(f, 0), corner(f, 1), corner(f, 2)};
    TileVertex look = surface(f, lit);
    if (lit || (emission_specks_ && emits(look))) {
      SampleCount samples(scene_.camera, scene_.oversampling);
      samples.add(p);
      if (specks_ && samples.sparse()) {
        if (!emission_specks_) put_out(look);
        add_specks(look, p);
        look = surface(f, false);
        if (emission_specks_) put_out(look);
      } else if (samples.narrow()) {
        scale(look, samples.correction());
      }
    }
    add(look, f, p, {{{0, 0}, {1, 0}, {0, 1}}});
  }

  bool emits(const TileVertex& look) const {
    return look.emitted[0] > 0.0f || look.emitted[1] > 0.0f || look.emitted[2] > 0.0f;
  }

  static void put_out(TileVertex& look) {
    for (int k = 0; k < 3; ++k) look.emitted[k] = 0.0f;
  }

  void add_parts(std::size_t f, std::span<const FacetPiece> pieces) {
    const glm::dvec3 o = corner(f, 0), e1 = corner(f, 1) - o, e2 = corner(f, 2) - o;
    std::vector<SampleCount::Triangle> parts;
    std::vector<Places> places;
    SampleCount samples(scene_.camera, scene_.oversampling);
    for (const auto& piece : pieces) {
      const auto at = [&](int i) {
        const auto& [s, t] = piece.corner[std::size_t(i)];
        return o + e1 * s + e2 * t;
      };
      for (int i = 1; i + 1 < piece.corners; ++i) {
        const SampleCount::Triangle part{at(0), at(i), at(i + 1)};
        SampleCount alone(scene_.camera, scene_.oversampling);
        alone.add(part);
        if (specks_ && alone.sparse()) {  // on the dark underlay, which has the emission
          TileVertex look = surface(f, true);
          put_out(look);
          add_specks(look, part);
          continue;
        }
        parts.push_back(part);
        places.push_back(
            {piece.corner[0], piece.corner[std::size_t(i)], piece.corner[std::size_t(i) + 1]});
        samples.add(part);
      }
    }
    TileVertex look = surface(f, true);
    scale(look, samples.correction());
    for (std::size_t i = 0; i < parts.size(); ++i) add(look, f, parts[i], places[i]);
  }

  /// Light of a triangle in pieces of a pixel.
  void add_specks(const TileVertex& look, const SampleCount::Triangle& whole) {
    constexpr std::size_t most = 1 << 16;
    std::vector<SampleCount::Triangle> pieces{whole};
    for (std::size_t done = 0; done < pieces.size();) {
      const SampleCount::Triangle p = pieces[done];
      SampleCount samples(scene_.camera, scene_.oversampling);
      samples.add(p);
      if (samples.beside()) {
        pieces[done] = pieces.back();
        pieces.pop_back();
        continue;
      }
      if (samples.longest() <= scene_.oversampling || pieces.size() >= most) {
        add_speck(look, p, samples.whole_area());
        ++done;
        continue;
      }
      std::size_t side = 0;
      const auto length = [&](std::size_t i) { return glm::length(p[(i + 1) % 3] - p[i]); };
      for (std::size_t i = 1; i < 3; ++i)
        if (length(i) > length(side)) side = i;
      const glm::dvec3 middle = (p[side] + p[(side + 1) % 3]) / 2.0;
      pieces[done] = {p[side], middle, p[(side + 2) % 3]};
      pieces.push_back({middle, p[(side + 1) % 3], p[(side + 2) % 3]});
    }
  }

  /// Light of a triangle as shaded at its centre, times its area; none if that is beside the tile.
  void add_speck(const TileVertex& look, const SampleCount::Triangle& p, double area_samples) {
    const glm::dvec3 middle = (p[0] + p[1] + p[2]) / 3.0;
    const glm::dvec3 n(look.normal);
    const glm::dvec3 view = -middle / glm::length(middle);
    const glm::dvec3 source = camera_from_body_ * glm_of(source_.to_source);
    const double c = glm::dot(n, view);
    if (!(c > 0.0)) return;
    const glm::dvec3 h = view + source;
    const double cos2 =
        std::min(1.0, glm::dot(n, h) * glm::dot(n, h) / std::max(glm::dot(h, h), 1e-30));
    const double root = look.specular.w * cos2 + (1.0 - cos2);
    const double mirror =
        std::clamp(2.0 * glm::dot(n, source) * c - glm::dot(view, source), 0.0, 1.0);
    const double lobe = look.emitted.w < 0.0f ? 1.0 / (root * root * std::max(c, min_cos_out))
                        : mirror > 0.0        ? std::pow(mirror, double(look.emitted.w))
                                              : 0.0;
    const double falloff = c * c / (c * c + look.diffuse.w * (1.0 - c * c));
    const double pixels = area_samples / (scene_.oversampling * double(scene_.oversampling));
    TileMesh::Speck speck{};
    const TileCamera& camera = scene_.camera;
    speck.place_px = {camera.principal_x_px - camera.left + camera.focal_px * middle.x / middle.z,
                      camera.principal_y_px - camera.top + camera.focal_px * middle.y / middle.z};
    if (!(speck.place_px.x >= -0.5f && speck.place_px.y >= -0.5f &&
          speck.place_px.x < float(camera.columns) - 0.5f &&
          speck.place_px.y < float(camera.rows) - 0.5f))
      return;
    for (int k = 0; k < bands_; ++k)
      speck.light[k] =
          float((look.diffuse[k] * falloff + look.specular[k] * lobe + look.emitted[k]) * pixels);
    out_.specks.push_back(speck);
  }

  const TileScene& scene_;
  const LightSource& source_;
  std::size_t first_;
  int bands_;
  bool emission_;
  bool specks_;           // light of the source goes into specks where samples are few
  bool emission_specks_;  // so does thermal emission
  bool textured_ = false;
  glm::dmat3 camera_from_body_;
  ClipSpace clip_;
  std::array<std::vector<int>, 3> lobe_of_;
  std::vector<glm::dvec3> place_;
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
  lit.convex = convex;
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
  return Builder(scene, source, first_band, with_emission, lit).build(lit);
}

}  // namespace dmise
