#pragma once
#include <algorithm>
#include <cmath>
#include <variant>

#include "core/base/units.h"
#include "core/materials/brdf.h"

// The models of core/materials/brdf.h written out, against which its closed forms and the sums over
// facets are tested.
namespace dmise {

/// Geometry of a reflection: cosines of the angles between the normal and the directions to source
/// and viewer, and between these two (the phase angle).
struct Reflection {
  double cos_in = 1.0;
  double cos_out = 1.0;
  double cos_phase = 1.0;
};

inline constexpr double pole_cos_out = 1e-6;  // f is finite down to here

inline double per_sr(const Lambert& m, const Reflection&, double) { return m.reflectance / pi; }

/// With 1/cos_out of the lobe limited to 1/`min_cos`.
inline double per_sr(const SandfordRobertson& m, const Reflection& at, double min_cos) {
  const double mean = sandford_robertson_mean(m.grazing);
  const double falloff_in = sandford_robertson_falloff(at.cos_in, m.grazing);
  const double falloff_out = sandford_robertson_falloff(at.cos_out, m.grazing);
  const double diffuse = m.diffuse * falloff_in * falloff_out / (pi * mean * mean);
  const double specular = 1.0 - (m.emissivity + m.diffuse) * falloff_in / mean;
  // With unit vectors to source and viewer the half vector has length sqrt(2 + 2 cos_phase); it is
  // 0 only where the surface cannot be seen lit.
  const double sum = at.cos_in + at.cos_out;
  const double cos2_half = std::min(1.0, sum * sum / std::max(2.0 + 2.0 * at.cos_phase, sum * sum));
  const double e2 = m.lobe_width * m.lobe_width;
  const double root = e2 * cos2_half + (1.0 - cos2_half);
  const double lobe = 1.0 / (root * root);
  const double norm = sandford_robertson_lobe_norm(at.cos_in, m.lobe_width);
  return diffuse +
         std::max(0.0, specular) * lobe / (4.0 * pi * norm * std::max(at.cos_out, min_cos));
}

inline double per_sr(const Phong& m, const Reflection& at, double) {
  const double cos_mirror = std::clamp(2.0 * at.cos_in * at.cos_out - at.cos_phase, 0.0, 1.0);
  return m.diffuse / pi + (cos_mirror > 0.0 ? m.specular * (m.exponent + 2.0) / (2.0 * pi) *
                                                  std::pow(cos_mirror, m.exponent)
                                            : 0.0);
}

/// f [1/sr] of the model; 0 below the surface on either side. Held constant only below a cosine of
/// 1e-6.
inline double brdf_per_sr(const Brdf& brdf, const Reflection& at) {
  if (!(at.cos_in > 0.0 && at.cos_out > 0.0)) return 0.0;
  return std::visit([&](const auto& model) { return per_sr(model, at, pole_cos_out); }, brdf);
}

/// f cos_in cos_out: radiant intensity of a unit area in a unit irradiance [1/sr], with
/// `min_cos_out`. Finite everywhere, continuous to 0 at grazing exit.
inline double reflected_per_sr(const Brdf& brdf, const Reflection& at) {
  if (!(at.cos_in > 0.0 && at.cos_out > 0.0)) return 0.0;
  return std::visit([&](const auto& model) { return per_sr(model, at, min_cos_out); }, brdf) *
         at.cos_in * at.cos_out;
}

}  // namespace dmise
