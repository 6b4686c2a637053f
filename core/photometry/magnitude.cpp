#include "core/photometry/magnitude.h"

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/photometry/spectrum.h"

namespace dmise {

double light_of_magnitude(double mag) { return std::exp(-mag * (0.4 * std::numbers::ln10)); }

double magnitude_of_light(double light) { return -2.5 * std::log10(light); }

const Band& johnson_v() {
  static const Band band = *filter_named("bessell-V");
  return band;
}

double zero_point_photons_per_s_m2(const Band& band) {
  const double vega_mag = band.name == "bessell-U" ? 0.024 : 0.03;
  return photon_rate_per_m2(vega_spectrum(), band) / light_of_magnitude(vega_mag);
}

double ab_zero_point_photons_per_s_m2(const Band& band) {
  // F_nu / (h nu) d nu = F_nu / h d ln(wavelength): as a spectrum, F_nu c / x^2, whose photons go
  // as 1/x.
  check_band(band);
  constexpr double ab_w_per_m2_hz = 3631e-26;
  const std::vector<double> at = knots(band);
  double sum = 0.0;
  for (std::size_t i = 1; i < at.size(); ++i) {
    // Response a + b x between knots: integral of (a + b x) / x.
    const double low = band.response.at_or_zero(at[i - 1]), high = band.response.at_or_zero(at[i]);
    const double slope = (high - low) / (at[i] - at[i - 1]);
    sum += (low - slope * at[i - 1]) * std::log(at[i] / at[i - 1]) + slope * (at[i] - at[i - 1]);
  }
  return ab_w_per_m2_hz / planck_j_s * sum;
}

MagnitudeScale magnitude_scale(MagnitudeSystem system, const Band& band) {
  if (system == MagnitudeSystem::v_solar) return {};
  if (system == MagnitudeSystem::vega &&
      band.high_m() > vega_spectrum().irradiance.wavelength_m.back())
    throw Error("Vega: its spectrum ends at 2.195 um, before the band " + band.name +
                " does: take AB or V-solar");
  const double zero = system == MagnitudeSystem::vega ? zero_point_photons_per_s_m2(band)
                                                      : ab_zero_point_photons_per_s_m2(band);
  return {system, magnitude_of_light(sunlight_photons_per_s_m2(0.0, band) / zero)};
}

double sunlight_photons_per_s_m2(double v_mag, const Band& band) {
  static const double per_v_photon =
      zero_point_photons_per_s_m2(johnson_v()) / photon_rate_per_m2(solar_spectrum(), johnson_v());
  return light_of_magnitude(v_mag) * per_v_photon * photon_rate_per_m2(sunlight_spectrum(), band);
}

}  // namespace dmise
