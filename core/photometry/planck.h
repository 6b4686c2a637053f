#pragma once
#include <cmath>

#include "core/base/units.h"
#include "core/photometry/band.h"

// Heat: Planck's law.
namespace dmise {

/// Bands that reach beyond see the heat of the air and of the optics. Below, at 300 K, a black body
/// gives less than 1e-3 of the airglow.
inline constexpr double thermal_from_m = 1.9e-6;
inline bool is_thermal(const Band& band) { return band.high_m() > thermal_from_m; }

inline constexpr double zero_celsius_k = 273.15;

/// Spectral radiance of a black body [W/m2/sr/m]; 0 at 0 K.
inline double planck_w_per_m2_sr_m(double wavelength_m, double temperature_k) {
  if (!(temperature_k > 0.0)) return 0.0;
  constexpr double second_constant_m_k = planck_j_s * speed_of_light_m_per_s / boltzmann_j_per_k;
  const double l = wavelength_m;
  const double exponent = second_constant_m_k / (l * temperature_k);
  return 2.0 * planck_j_s * speed_of_light_m_per_s * speed_of_light_m_per_s / (l * l * l * l * l) /
         std::expm1(exponent);
}

/// Photons/s/m2/sr of a radiance [W/m2/sr/m] over a band, weighted by its response. Midpoint sum
/// with a relative error below 1e-3 for bands of up to half their wavelength.
template <class Radiance>
double photons_of_radiance(const Band& band, const Radiance& w_per_m2_sr_m, int steps = 256) {
  const double low = band.low_m(), step = (band.high_m() - low) / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double wavelength_m = low + (i + 0.5) * step;
    sum += band.response.at_or_zero(wavelength_m) * w_per_m2_sr_m(wavelength_m) * wavelength_m /
           (planck_j_s * speed_of_light_m_per_s);
  }
  return sum * step;
}

}  // namespace dmise
