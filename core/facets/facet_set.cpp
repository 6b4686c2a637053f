#include "core/facets/facet_set.h"

#include "core/base/units.h"
#include "core/facets/facet_texture.h"
#include "core/materials/thermal.h"

namespace dmise {
namespace {

/// Array entries of one material.
struct Coefficients {
  double diffuse = 0.0, taken = 1.0, grazing2 = 0.0, lobe2 = 1.0;
  double phong_scale = 0.0, exponent = 0.0;
};

Coefficients coefficients(const Lambert& m) { return {.diffuse = m.reflectance / pi}; }

Coefficients coefficients(const Phong& m) {
  return {.diffuse = m.diffuse / pi,
          .phong_scale = m.specular * (m.exponent + 2.0) / (2.0 * pi),
          .exponent = m.exponent};
}

Coefficients coefficients(const SandfordRobertson& m) {
  const double mean = sandford_robertson_mean(m.grazing);
  return {.diffuse = m.diffuse / (pi * mean * mean),
          .taken = (m.emissivity + m.diffuse) / mean,
          .grazing2 = m.grazing * m.grazing,
          .lobe2 = m.lobe_width * m.lobe_width};
}

}  // namespace

FacetSet facet_set(const Mesh& mesh, const Band& band) {
  std::vector<Coefficients> of_material;
  std::vector<double> emitted;
  for (const auto& material : mesh.materials) {
    of_material.push_back(std::visit([](const auto& brdf) { return coefficients(brdf); },
                                     brdf_in_band(material, band)));
    emitted.push_back(emitted_photons_per_s_m2_sr(material, band));
  }
  FacetSet set;
  set.count = mesh.triangles.size();
  const std::size_t padded = (set.count + 7) / 8 * 8;
  for (auto* array : {&set.normal_x, &set.normal_y, &set.normal_z, &set.area_m2, &set.diffuse,
                      &set.taken, &set.grazing2, &set.lobe2, &set.emitted})
    array->assign(padded, 0.0);
  for (std::size_t i = set.count; i < padded; ++i) set.normal_z[i] = set.lobe2[i] = 1.0;
  for (std::size_t i = 0; i < set.count; ++i) {
    const auto& triangle = mesh.triangles[i];
    const Vec<Body> twice = double_area_m2(mesh, triangle);
    const double length = norm(twice);
    const Vec<Body> normal = length > 0.0 ? twice / length : Vec<Body>{0, 0, 1};
    const Coefficients& c = of_material[triangle.material];
    set.normal_x[i] = normal.x;
    set.normal_y[i] = normal.y;
    set.normal_z[i] = normal.z;
    set.area_m2[i] = length / 2;
    set.diffuse[i] = c.diffuse;
    set.taken[i] = c.taken;
    set.grazing2[i] = c.grazing2;
    set.lobe2[i] = c.lobe2;
    set.emitted[i] = emitted[triangle.material];
    if (c.phong_scale > 0.0) set.lobes.push_back({std::uint32_t(i), c.phong_scale, c.exponent});
  }
  add_textures(mesh, band, set);
  return set;
}

}  // namespace dmise
