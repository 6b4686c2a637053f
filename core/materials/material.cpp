#include "core/materials/material.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

double or_zero(const Curve& curve, double wavelength_m) {
  return curve.empty() ? 0.0 : curve.at_or_end(wavelength_m);
}

/// The model with each table evaluated by `value`.
template <class Value>
Brdf brdf_of(const Material& m, Value&& value) {
  switch (m.model) {
    case Material::Model::sandford_robertson:
      return SandfordRobertson{.emissivity = value(m.emissivity),
                               .diffuse = value(m.diffuse),
                               .grazing = m.grazing,
                               .lobe_width = m.lobe_width};
    case Material::Model::phong:
      return Phong{
          .diffuse = value(m.diffuse), .specular = value(m.specular), .exponent = m.exponent};
    case Material::Model::lambert:
      break;
  }
  return Lambert{value(m.reflectance)};
}

}  // namespace

Material sandford_robertson_of(std::string name, const Curve& reflectance, double diffuse_share,
                               double grazing, double lobe_width) {
  const double mean = sandford_robertson_mean(grazing);
  Material m{.name = std::move(name),
             .model = Material::Model::sandford_robertson,
             .reflectance = {},
             .emissivity = reflectance,
             .diffuse = reflectance,
             .grazing = grazing,
             .lobe_width = lobe_width};
  for (double& value : m.emissivity.value) value = (1.0 - value) * mean;
  for (double& value : m.diffuse.value) value *= diffuse_share * mean;
  return m;
}

Brdf brdf_at(const Material& material, double wavelength_m) {
  return brdf_of(material, [&](const Curve& curve) { return or_zero(curve, wavelength_m); });
}

Brdf brdf_in_band(const Material& material, const Band& band) {
  constexpr int steps = 256;
  const Curve& sun = sunlight_spectrum().irradiance;
  const double low = band.low_m(), step = (band.high_m() - low) / steps;
  return brdf_of(material, [&](const Curve& curve) {
    double sum = 0.0, weights = 0.0;
    for (int i = 0; i < steps; ++i) {
      const double wavelength_m = low + (i + 0.5) * step;
      const double weight =
          band.response.at_or_zero(wavelength_m) * wavelength_m * sun.at_or_end(wavelength_m);
      sum += weight * or_zero(curve, wavelength_m);
      weights += weight;
    }
    return weights > 0.0 ? sum / weights : or_zero(curve, band.centre_m);
  });
}

void check_material(const Material& m) {
  const std::string name = "material " + m.name;
  std::vector<double> wavelengths;
  const auto take = [&](const Curve& curve, const char* what) {
    check_curve(curve, (name + ": " + what).c_str());
    wavelengths.insert(wavelengths.end(), curve.wavelength_m.begin(), curve.wavelength_m.end());
  };
  take(m.reflectance, "reflectance");
  take(m.emissivity, "emissivity");
  take(m.diffuse, "diffuse");
  take(m.specular, "specular");
  if (wavelengths.empty()) throw Error(name + ": no value at any wavelength");
  // Sums of tables are linear between the samples of all tables.
  for (const double wavelength_m : wavelengths) check_brdf(brdf_at(m, wavelength_m), name);
  if (!(m.temperature_k >= 0.0 && m.temperature_k <= 3000.0))
    throw Error(name + ": temperature_k must be in [0, 3000], got " +
                std::to_string(m.temperature_k));
  if (!(m.thermal_emissivity >= 0.0 && m.thermal_emissivity <= 1.0))
    throw Error(name + ": thermal_emissivity must be in [0, 1], got " +
                std::to_string(m.thermal_emissivity));
}

}  // namespace dmise
