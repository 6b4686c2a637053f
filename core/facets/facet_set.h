#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/materials/mesh.h"

namespace dmise {

/// The facets of a mesh with their reflectance in one band, as arrays for the kernels. All models
/// use the formula of Sandford-Robertson, whose diffuse part with grazing 0 is Lambert's; Phong's
/// lobe is added if there is one.
struct FacetSet {
  std::size_t count = 0;  // facets; arrays are padded to a multiple of 8 with zero area
  std::vector<double> normal_x, normal_y, normal_z;
  std::vector<double> area_m2;
  std::vector<double> diffuse;   // rho_D / (pi G^2) [1/sr]
  std::vector<double> taken;     // (eps + rho_D) / G; 1: no lobe
  std::vector<double> grazing2;  // b^2
  std::vector<double> lobe2;     // e^2
  std::vector<double> emitted;   // photons/s/m2/sr in the band

  struct PhongLobe {
    std::uint32_t facet;
    double scale;  // ks (n + 2) / (2 pi) [1/sr]
    double exponent;
  };
  std::vector<PhongLobe> lobes;

  /// Share of red, green and blue of a picture in the reflectance, by material.
  std::vector<std::array<float, 3>> colour_weights;
  /// Mean of the picture over each facet, already included in `diffuse`; empty without pictures.
  std::vector<float> colour_mean;

  /// A facet with a height map: representative normals, which are means rather than unit vectors,
  /// so that Lambert's part is exact where none is turned away from the light.
  struct Bumps {
    std::uint32_t facet;
    std::size_t begin, end;  // in `bump_normals`
    double phong_scale, exponent;
  };
  struct BumpNormal {
    Vec<Body> normal;
    double share = 0.0;    // part of the facet that has it
    double diffuse = 0.0;  // as above, of the picture there
  };
  std::vector<Bumps> bumps;
  std::vector<BumpNormal> bump_normals;

  Vec<Body> normal(std::size_t i) const { return {normal_x[i], normal_y[i], normal_z[i]}; }
};

/// Facet i is the mesh's triangle i.
FacetSet facet_set(const Mesh& mesh, const Band& band);

}  // namespace dmise
