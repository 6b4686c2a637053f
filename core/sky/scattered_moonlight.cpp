#include "core/sky/scattered_moonlight.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/airmass.h"
#include "core/sky/surface_brightness.h"

namespace dmise {

double moon_v_mag(double phase_rad) {
  const double phase_deg = std::abs(phase_rad) / deg;
  return -12.73 + 0.026 * phase_deg + 4e-9 * phase_deg * phase_deg * phase_deg * phase_deg;
}

double moonlight_scattering(double angle_from_moon_rad) {
  const double angle_deg = angle_from_moon_rad / deg;
  const double c = std::cos(angle_from_moon_rad);
  const double rayleigh = 229086.76527677724 * (1.06 + c * c);        // 10^5.36
  double mie = light_of_magnitude(-2.5 * (6.15 - angle_deg / 40.0));  // 10^(6.15 - angle/40)
  if (angle_deg < 10.0) {
    const double held_deg = std::max(angle_deg, moonlight_held_within_deg);
    mie = std::max(mie, 6.2e7 / (held_deg * held_deg));
  }
  return rayleigh + mie;
}

double scattered_moonlight_s10(double angle_from_moon_rad, double sin_altitude,
                               double sin_moon_altitude, double moon_v_mag, double k_v) {
  // Equation 20: illuminance outside the atmosphere, V + 16.57 = -2.5 log I.
  const double illuminance = light_of_magnitude(moon_v_mag + 16.57);
  const double below_deg =
      std::max(0.0, -std::asin(std::clamp(sin_moon_altitude, -1.0, 1.0)) / deg);
  const double nanolambert = moonlight_scattering(angle_from_moon_rad) * illuminance *
                             light_of_magnitude(k_v * scattering_airmass(sin_moon_altitude)) *
                             (1.0 - light_of_magnitude(k_v * scattering_airmass(sin_altitude)));
  return s10_of_nanolambert(nanolambert) * light_of_magnitude(0.9 * below_deg);
}

}  // namespace dmise
