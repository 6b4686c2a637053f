#include "core/materials/thermal.h"

#include <cmath>

#include "core/base/units.h"

namespace dmise {

double planck_w_per_m2_sr_m(double wavelength_m, double temperature_k) {
  if (!(temperature_k > 0.0)) return 0.0;
  constexpr double second_constant_m_k = planck_j_s * speed_of_light_m_per_s / boltzmann_j_per_k;
  const double l = wavelength_m;
  const double exponent = second_constant_m_k / (l * temperature_k);
  return 2.0 * planck_j_s * speed_of_light_m_per_s * speed_of_light_m_per_s / (l * l * l * l * l) /
         std::expm1(exponent);
}

double emitted_photons_per_s_m2_sr(const Material& material, const Band& band) {
  constexpr int steps = 256;
  const double low = band.low_m(), step = (band.high_m() - low) / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double wavelength_m = low + (i + 0.5) * step;
    sum += band.response.at_or_zero(wavelength_m) *
           planck_w_per_m2_sr_m(wavelength_m, material.temperature_k) * wavelength_m /
           (planck_j_s * speed_of_light_m_per_s);
  }
  return material.thermal_emissivity * (sum * step);
}

}  // namespace dmise
