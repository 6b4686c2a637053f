#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/materials/brdf.h"
#include "core/photometry/band.h"

namespace dmise {

struct Texture;

/// Optical properties of a surface over wavelength. Tables are linear between their samples and
/// keep their end values outside; the shape of a lobe does not depend on wavelength.
struct Material {
  enum class Model { lambert, sandford_robertson, phong };

  std::string name = "grey";
  std::string source;  // where the numbers come from
  Model model = Model::lambert;
  Curve reflectance{{0.55e-6}, {0.2}};        // lambert: of all light, [0, 1]
  Curve emissivity;                           // sandford_robertson: eps
  Curve diffuse;                              // sandford_robertson: rho_D; phong: kd
  Curve specular;                             // phong: ks
  double grazing = 0.3;                       // sandford_robertson: b
  double lobe_width = 0.3;                    // sandford_robertson: e
  double exponent = 1.0;                      // phong: n
  double temperature_k = 0.0;                 // for thermal emission; 0: none
  double thermal_emissivity = 0.0;            // grey, of that emission, [0, 1]
  std::shared_ptr<const Texture> colour_map;  // phong: times `diffuse`, by red, green and blue
  std::shared_ptr<const Texture> slope_map;   // phong: of heights, times `height_m`
  double height_m = 1.0;                      // white above black in `slope_map`

  bool operator==(const Material&) const = default;
};

/// Sandford-Robertson whose reflectance at normal incidence is `reflectance`, of which
/// `diffuse_share` is diffuse: eps = (1 - R) G(b), rho_D = share R G(b).
Material sandford_robertson_of(std::string name, const Curve& reflectance, double diffuse_share,
                               double grazing, double lobe_width);

/// BRDF at one wavelength.
Brdf brdf_at(const Material& material, double wavelength_m);

/// BRDF for photons of sunlight in a band: exact for the model, because f is linear in everything
/// that depends on wavelength; the mean is a midpoint sum with a relative error below 1e-3 for
/// tables of 10 nm.
Brdf brdf_in_band(const Material& material, const Band& band);

/// Throws `Error` "material NAME: reason, got value" unless it conserves energy at every
/// wavelength.
void check_material(const Material& material);

}  // namespace dmise
