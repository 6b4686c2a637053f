#include "core/sky/scattered_moonlight.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/photometry/magnitude.h"
#include "core/sky/air/airmass.h"
#include "core/sky/surface_brightness.h"

namespace dmise {

ErrorBound ScatteredMoonlight::error(int, const PlanFacts& f) {
  return f.without_part(SkyPart::scattered_moonlight);
}

double ScatteredMoonlight::cost_s(int level, const PlanFacts& f) {
  return level * 245e-9 * f.sky_looks();
}

double moon_v_mag(double phase_rad) {
  const double phase_deg = std::abs(phase_rad) / deg;
  return -12.73 + 0.026 * phase_deg + 4e-9 * phase_deg * phase_deg * phase_deg * phase_deg;
}

double opposition_surge_mag(double phase_rad) {
  constexpr double within_deg = 7.0;
  const double surge_mag = magnitude_of_light(1.35);
  return surge_mag * std::max(0.0, 1.0 - std::abs(phase_rad) / deg / within_deg);
}

const Spectrum& moonlight_spectrum() {
  static const Spectrum spectrum = [] {
    const Curve reflectance{{350 * nm, 400 * nm, 450 * nm, 550 * nm, 650 * nm, 800 * nm, 1000 * nm,
                             1300 * nm, 1700 * nm, 2400 * nm},
                            {0.577, 0.703, 0.815, 1.0, 1.143, 1.308, 1.480, 1.710, 2.047, 2.866}};
    return times(sunlight_spectrum(), [&](double x_m) { return reflectance.at_or_end(x_m); });
  }();
  return spectrum;
}

MoonlitAir moonlit_air(const Band& band, double k_v, double k) {
  if (!(k > 0.0 && k_v > 0.0)) return {k, 1.0, 1.0};
  const auto over_v = [&](double power) {
    const Spectrum scattered =
        times(moonlight_spectrum(), [&](double x_m) { return std::pow(x_m / (550 * nm), -power); });
    const auto mean = [&](const Band& in) {
      return photon_rate_per_m2(scattered, in) / photon_rate_per_m2(moonlight_spectrum(), in);
    };
    return mean(band) / mean(johnson_v()) * k_v / k;
  };
  return {k, over_v(4.08), over_v(1.3)};
}

double moonlight_scattering(double angle_from_moon_rad, const MoonlitAir& air) {
  const double angle_deg = angle_from_moon_rad / deg;
  const double c = std::cos(angle_from_moon_rad);
  const double rayleigh = 229086.76527677724 * (1.06 + c * c);        // 10^5.36
  double mie = light_of_magnitude(-2.5 * (6.15 - angle_deg / 40.0));  // 10^(6.15 - angle/40)
  if (angle_deg < 10.0) {
    const double held_deg = std::max(angle_deg, moonlight_held_within_deg);
    mie = std::max(mie, 6.2e7 / (held_deg * held_deg));
  }
  return air.molecules * rayleigh + air.haze * mie;
}

double scattered_moonlight_s10(double angle_from_moon_rad, double sin_altitude,
                               double sin_moon_altitude, double moon_v_mag, const MoonlitAir& air) {
  // Equation 20: illuminance outside the atmosphere, V + 16.57 = -2.5 log I.
  const double illuminance = light_of_magnitude(moon_v_mag + 16.57);
  const double below_deg =
      std::max(0.0, -std::asin(std::clamp(sin_moon_altitude, -1.0, 1.0)) / deg);
  const double k = air.extinction_mag;
  const double nanolambert = moonlight_scattering(angle_from_moon_rad, air) * illuminance *
                             light_of_magnitude(k * scattering_airmass(sin_moon_altitude)) *
                             (1.0 - light_of_magnitude(k * scattering_airmass(sin_altitude)));
  return s10_of_nanolambert(nanolambert) * light_of_magnitude(0.9 * below_deg);
}

}  // namespace dmise
