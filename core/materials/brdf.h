#pragma once
#include <string_view>
#include <variant>

// What a surface does with light: the bidirectional reflectance distribution function f [1/sr] of
// isotropic surfaces, at one wavelength or in one band.
namespace dmise {

/// One reflection, by the cosines that isotropic models need: of the normal with the directions to
/// the source and to the viewer, and between those two (the phase angle).
struct Reflection {
  double cos_in = 1.0;
  double cos_out = 1.0;
  double cos_phase = 1.0;
};

/// The same in all directions.
struct Lambert {
  double reflectance = 0.2;  // [0, 1]

  bool operator==(const Lambert&) const = default;
};

/// Sandford & Robertson 1985, "Infrared reflectance properties of aircraft paints", as the physics
/// of this system states it: a diffuse part that falls off towards grazing and a lobe about the
/// half vector that takes what is neither emitted nor diffuse. Not reciprocal.
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

/// To add a model: write its struct here, its overloads in brdf.cpp and in facet_light.cpp, its
/// shader in sensors/render, read it in core/config/material_config.cpp, test it in
/// tests/materials.
using Brdf = std::variant<Lambert, SandfordRobertson, Phong>;

/// Below this cosine of the viewing angle (88.9 deg) the 1/cos_out of Sandford-Robertson's lobe is
/// held where light is summed or drawn, so that a facet's light goes to 0 as it turns edge-on
/// instead of ending at its brightest. Of a lobe as wide as the hemisphere at normal incidence that
/// takes 1 % of the light, of narrower ones less. A knob of this system, not of the model.
inline constexpr double least_cos_out = 0.02;

/// f [1/sr], the model's own; 0 from behind the surface on either side. Held only below 1e-6.
double brdf_per_sr(const Brdf& brdf, const Reflection& at);

/// f cos_in cos_out: radiant intensity of a unit area in a unit irradiance [1/sr], with
/// `least_cos_out`. Finite everywhere, continuous to 0 at grazing exit.
double reflected_per_sr(const Brdf& brdf, const Reflection& at);

/// Share of light from one direction that is reflected into all, [0, 1]. In closed form for Lambert
/// and Sandford-Robertson; by quadrature to 1e-6 for Phong.
double directional_reflectance(const Brdf& brdf, double cos_in);

/// Throws `Error` "NAME: reason, got value" for a parameter outside the ranges above, which would
/// reflect more than falls in.
void check_brdf(const Brdf& brdf, std::string_view name);

/// g(t) = cos^2 t / (cos^2 t + b^2 sin^2 t), by the cosine.
double sandford_robertson_falloff(double cos_angle, double grazing);
/// G(b), the mean of g over the hemisphere: 1 at 0, 1/2 at 1, relative error below 1e-13.
double sandford_robertson_mean(double grazing);
/// H(ti, e), which normalises the lobe.
double sandford_robertson_lobe_norm(double cos_in, double lobe_width);

}  // namespace dmise
