#include "core/materials/thermal.h"

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double second_constant_m_k =
    planck_j_s * speed_of_light_m_per_s / boltzmann_j_per_k;  // h c / k

/// Radiance at wavelengths up to `wavelength_m` [W/m2/sr], x = h c / (lambda k T):
/// (2 k^4 T^4 / (h^3 c^2)) sum_n e^(-n x) (x^3/n + 3 x^2/n^2 + 6 x/n^3 + 6/n^4).
double radiance_below(double wavelength_m, double temperature_k) {
  if (!(wavelength_m > 0.0)) return 0.0;
  const double x = second_constant_m_k / (wavelength_m * temperature_k);
  const double kt = boltzmann_j_per_k * temperature_k;
  const double scale =
      2.0 * kt * kt * kt * kt /
      (planck_j_s * planck_j_s * planck_j_s * speed_of_light_m_per_s * speed_of_light_m_per_s);
  if (x < 0.02) {  // pi^4/15 less the tail, x^3/3 - x^4/8 + x^5/60
    return scale * (pi * pi * pi * pi / 15 - x * x * x * (1.0 / 3 - x / 8 + x * x / 60));
  }
  double sum = 0.0;
  for (int n = 1; n <= 2000 && n * x < 60.0 + x; ++n) {
    const double m = n;
    sum += std::exp(-m * x) *
           (((x / m + 3.0 / (m * m)) * x + 6.0 / (m * m * m)) * x + 6.0 / (m * m * m * m));
  }
  return scale * sum;
}

}  // namespace

double planck_w_per_m2_sr_m(double wavelength_m, double temperature_k) {
  if (!(temperature_k > 0.0)) return 0.0;
  const double l = wavelength_m;
  const double exponent = second_constant_m_k / (l * temperature_k);
  return 2.0 * planck_j_s * speed_of_light_m_per_s * speed_of_light_m_per_s / (l * l * l * l * l) /
         std::expm1(exponent);
}

double black_body_radiance_w_per_m2_sr(double temperature_k, double low_m, double high_m) {
  if (!(temperature_k > 0.0) || !(high_m > low_m)) return 0.0;
  return radiance_below(high_m, temperature_k) - radiance_below(low_m, temperature_k);
}

double black_body_radiance_photons_per_s_m2_sr(double temperature_k, const Band& band) {
  constexpr int steps = 256;
  const double low = band.low_m(), step = (band.high_m() - low) / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double wavelength_m = low + (i + 0.5) * step;
    const double response = band.response.empty() ? 1.0 : band.response.at_or_zero(wavelength_m);
    sum += response * planck_w_per_m2_sr_m(wavelength_m, temperature_k) * wavelength_m /
           (planck_j_s * speed_of_light_m_per_s);
  }
  return sum * step;
}

double emitted_photons_per_s_m2_sr(const Material& material, const Band& band) {
  return material.thermal_emissivity *
         black_body_radiance_photons_per_s_m2_sr(material.temperature_k, band);
}

}  // namespace dmise
