#pragma once
#include <string_view>
#include <variant>

// Bidirectional reflectance distribution functions f [1/sr] of isotropic surfaces, at one
// wavelength or in one band.
namespace dmise {

/// Equal radiance in all directions.
struct Lambert {
  double reflectance = 0.2;  // [0, 1]

  bool operator==(const Lambert&) const = default;
};

/// Sandford & Robertson 1985, "Infrared reflectance properties of aircraft paints", in the form
/// used by this project: a diffuse part that decreases towards grazing and a lobe about the half
/// vector for what is neither emitted nor diffuse. Not reciprocal.
struct SandfordRobertson {
  double emissivity = 0.5;  // >= 0; emissivity + diffuse <= sandford_robertson_mean(grazing)
  double diffuse = 0.1;     // >= 0
  double grazing = 0.3;     // b, [0, 10]: 0 keeps the diffuse part up to grazing
  double lobe_width = 0.3;  // e, [0.001, 1]: 1 is a lobe as wide as the hemisphere

  bool operator==(const SandfordRobertson&) const = default;
};

/// Phong's lobe about the mirror direction with Lafortune & Willems' normalisation (1994, "Using
/// the modified Phong reflectance model for physically based rendering"): kd/pi + ks (n+2)/(2 pi)
/// cos^n.
struct Phong {
  double diffuse = 0.2;   // kd >= 0, kd + ks <= 1
  double specular = 0.0;  // ks >= 0
  double exponent = 1.0;  // n, [0, 1e5]

  bool operator==(const Phong&) const = default;
};

/// To add a model: write its struct here, its overloads in brdf.cpp and facet_set.cpp, its shader
/// in sensors/render, its f in tests/materials/brdf_value.h, read it in
/// core/config/objects/material_config.cpp.
using Brdf = std::variant<Lambert, SandfordRobertson, Phong>;

/// Below this cosine of the viewing angle (88.9 deg) the factor 1/cos_out of the Sandford-Robertson
/// lobe is held constant where light is summed or drawn, so that a facet's light goes to 0 as it
/// turns edge-on. Costs 1 % of the light of a lobe as wide as the hemisphere at normal incidence,
/// less for narrower ones. A choice of this implementation, not of the model.
inline constexpr double min_cos_out = 0.02;

/// Fraction of the light from one direction that is reflected, [0, 1]. Closed form for Lambert and
/// Sandford-Robertson; quadrature to 1e-6 for Phong.
double directional_reflectance(const Brdf& brdf, double cos_in);

/// Throws `Error` "NAME: reason, got value" for a parameter outside the ranges above, with which
/// more light would be reflected than received.
void check_brdf(const Brdf& brdf, std::string_view name);

/// g(t) = cos^2 t / (cos^2 t + b^2 sin^2 t), by the cosine.
double sandford_robertson_falloff(double cos_angle, double grazing);
/// G(b), the mean of g over the hemisphere: 1 at 0, 1/2 at 1, relative error below 1e-13.
double sandford_robertson_mean(double grazing);
/// H(ti, e), the normalisation of the lobe.
double sandford_robertson_lobe_norm(double cos_in, double lobe_width);

}  // namespace dmise
