#include "core/facets/facet_texture.h"

#include <algorithm>
#include <cmath>

#include "core/materials/texture.h"

namespace dmise {
namespace {

constexpr double max_points = 5e7;   // over all facets
constexpr double max_normals = 2e6;  // for height maps, over all facets
constexpr int max_bins = 16;         // for a facet's slopes along each axis

/// Weights of red, green and blue in the material's reflectance in the band.
std::array<float, 3> weights_of(const Material& material, const Band& band) {
  const Curve& diffuse = material.diffuse;  // blue, green, red: order of MTL's colours
  std::array<double, 3> part{};
  for (std::size_t i = 0; i < 3; ++i) {
    Material one = material;
    for (std::size_t j = 0; j < 3; ++j) one.diffuse.value[j] = i == j ? diffuse.value[j] : 0.0;
    part[2 - i] = std::get<Phong>(brdf_in_band(one, band)).diffuse;
  }
  const double sum = part[0] + part[1] + part[2];
  if (!(sum > 0.0)) return {};
  return {float(part[0] / sum), float(part[1] / sum), float(part[2] / sum)};
}

/// Evenly distributed points in a triangle: the R2 sequence of M. Roberts (2018).
std::array<float, 2> point_in_triangle(std::size_t i) {
  double s = 0.5 + 0.7548776662466927 * double(i), t = 0.5 + 0.5698402909980532 * double(i);
  s -= std::floor(s);
  t -= std::floor(t);
  if (s + t > 1.0) {
    s = 1.0 - s;
    t = 1.0 - t;
  }
  return {float(s), float(t)};
}

TexturePlace place_in(const Mesh::Triangle& t, const Texture& texture, float s1, float s2) {
  const auto mixed = [&](float a, float b, float c) { return a + s1 * (b - a) + s2 * (c - a); };
  return texture.of({mixed(t.place[0].u, t.place[1].u, t.place[2].u),
                     mixed(t.place[0].v, t.place[1].v, t.place[2].v)});
}

double texels(const Mesh::Triangle& t, const Texture& texture) {
  const auto a = texture.of(t.place[0]), b = texture.of(t.place[1]), c = texture.of(t.place[2]);
  return 0.5 * std::abs((b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v)) * texture.columns *
         texture.rows;
}

class Facet {
 public:
  Facet(const Mesh& mesh, FacetSet& set, std::size_t i)
      : set_(set),
        i_(i),
        triangle_(mesh.triangles[i]),
        material_(mesh.materials[triangle_.material]) {
    if (material_.slope_map) {
      std::array<TexturePlace, 3> place;
      std::array<Vec<Body>, 3> corner_m;
      for (std::size_t k = 0; k < 3; ++k) {
        place[k] = material_.slope_map->of(triangle_.place[k]);
        corner_m[k] = mesh.vertex_m[triangle_.corner[k]];
      }
      gradient_ = place_gradients(corner_m, place);
    }
  }

  void sum(std::size_t facets_with_pictures) {
    double area = 0.0;
    for (const auto& map : {material_.colour_map, material_.slope_map})
      if (map) area = std::max(area, texels(triangle_, *map));
    bins_ = std::clamp(int(std::sqrt(max_normals / double(facets_with_pictures))), 2, max_bins);
    const double most = std::clamp(max_points / double(facets_with_pictures), 64.0, 65536.0);
    const auto points = std::size_t(std::clamp(64.0 * area, std::min(4096.0, most), most));
    std::vector<Bin> bin(std::size_t(bins_ * bins_));
    std::array<float, 2> least{}, max_slope{};
    if (material_.slope_map) slope_range(points, least, max_slope);
    double colours = 0.0;
    for (std::size_t p = 0; p < points; ++p) {
      const double colour = colour_at(p);
      colours += colour;
      if (!material_.slope_map) continue;
      const auto slope = slope_at(p);
      Bin& b = bin[std::size_t(bin_of(slope[0], least[0], max_slope[0]) * bins_ +
                               bin_of(slope[1], least[1], max_slope[1]))];
      b.normal += normal(slope);
      b.colour += colour;
      b.count += 1.0;
    }
    const double mean = colours / double(points), flat = set_.diffuse[i_];
    set_.colour_mean[i_] = float(mean);
    set_.diffuse[i_] = flat * mean;
    if (!material_.slope_map) return;
    const std::size_t begin = set_.bump_normals.size();
    for (const Bin& b : bin)
      if (b.count > 0.0)
        set_.bump_normals.push_back(
            {b.normal / b.count, b.count / double(points), flat * b.colour / b.count});
    set_.bumps.push_back({std::uint32_t(i_), begin, set_.bump_normals.size(), 0.0, 0.0});
  }

 private:
  struct Bin {
    Vec<Body> normal;
    double colour = 0.0, count = 0.0;
  };

  double colour_at(std::size_t p) const {
    if (!material_.colour_map) return 1.0;
    const auto [s, t] = point_in_triangle(p);
    const auto c = material_.colour_map->at(place_in(triangle_, *material_.colour_map, s, t));
    const auto& w = set_.colour_weights[triangle_.material];
    return w[0] * c[0] + w[1] * c[1] + w[2] * c[2];
  }

  std::array<float, 2> slope_at(std::size_t p) const {
    const auto [s, t] = point_in_triangle(p);
    const auto c = material_.slope_map->at(place_in(triangle_, *material_.slope_map, s, t));
    return {c[0], c[1]};
  }

  void slope_range(std::size_t points, std::array<float, 2>& least,
                   std::array<float, 2>& most) const {
    least = most = slope_at(0);
    for (std::size_t p = 1; p < points; ++p) {
      const auto slope = slope_at(p);
      for (std::size_t k = 0; k < 2; ++k) {
        least[k] = std::min(least[k], slope[k]);
        most[k] = std::max(most[k], slope[k]);
      }
    }
  }

  int bin_of(float slope, float least, float most) const {
    return most > least ? std::min(bins_ - 1, int(float(bins_) * (slope - least) / (most - least)))
                        : 0;
  }

  Vec<Body> normal(const std::array<float, 2>& slope) const {
    return unit(set_.normal(i_) -
                (gradient_[0] * double(slope[0]) + gradient_[1] * double(slope[1])) *
                    material_.height_m);
  }

  FacetSet& set_;
  std::size_t i_;
  const Mesh::Triangle& triangle_;
  const Material& material_;
  std::array<Vec<Body>, 2> gradient_{};
  int bins_ = 1;
};

}  // namespace

void add_textures(const Mesh& mesh, const Band& band, FacetSet& set) {
  const auto textured = [&](const Mesh::Triangle& t) {
    const Material& m = mesh.materials[t.material];
    return m.colour_map || m.slope_map;
  };
  const auto count =
      std::size_t(std::count_if(mesh.triangles.begin(), mesh.triangles.end(), textured));
  if (count == 0) return;
  for (const auto& material : mesh.materials)
    set.colour_weights.push_back(material.colour_map ? weights_of(material, band)
                                                     : std::array<float, 3>{});
  set.colour_mean.assign(set.count, 1.0f);
  for (std::size_t i = 0; i < set.count; ++i)
    if (textured(mesh.triangles[i])) Facet(mesh, set, i).sum(count);
  auto b = set.bumps.begin();
  for (const auto& lobe : set.lobes) {
    while (b != set.bumps.end() && b->facet < lobe.facet) ++b;
    if (b == set.bumps.end()) break;
    if (b->facet != lobe.facet) continue;
    b->phong_scale = lobe.scale;
    b->exponent = lobe.exponent;
  }
}

}  // namespace dmise
