#include "core/sky/twilight.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/airmass.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

constexpr double dark_v_mag_per_arcsec2 = 21.7;

double patat_v_mag_per_arcsec2(double depression_deg) {
  const double x = depression_deg - 5.0;
  return 11.84 + 1.518 * x - 0.057 * x * x;
}

/// Of twilight alone, at 5 to 14 deg.
double twilight_mag_per_arcsec2(double depression_deg) {
  return mag_per_arcsec2_of_s10(s10_of_mag_per_arcsec2(patat_v_mag_per_arcsec2(depression_deg)) -
                                s10_of_mag_per_arcsec2(dark_v_mag_per_arcsec2));
}

/// Cubic through (0, y0) and (width, y1) with slopes there.
double hermite(double x, double width, double y0, double slope0, double y1, double slope1) {
  const double t = x / width;
  return y0 + t * (slope0 * width + t * (3 * (y1 - y0) - (2 * slope0 + slope1) * width +
                                         t * (2 * (y0 - y1) + (slope0 + slope1) * width)));
}

double zenith_mag_per_arcsec2(double depression_deg) {
  constexpr double deepest = 14.0, shallowest = 5.0;
  constexpr double sunset = 7.2, sunset_slope = 0.6, day = 4.0;
  if (depression_deg >= deepest) {
    static const double there = twilight_mag_per_arcsec2(deepest);
    static const double slope = (there - twilight_mag_per_arcsec2(deepest - 1e-3)) / 1e-3;
    const double beyond = depression_deg - deepest;
    return there + beyond * (slope + 0.15 * beyond);
  }
  if (depression_deg >= shallowest) return twilight_mag_per_arcsec2(depression_deg);
  if (depression_deg >= 0) {
    static const double there = twilight_mag_per_arcsec2(shallowest);
    static const double slope = (twilight_mag_per_arcsec2(shallowest + 1e-3) - there) / 1e-3;
    return hermite(depression_deg, shallowest, sunset, sunset_slope, there, slope);
  }
  return std::max(sunset + sunset_slope * depression_deg, day);
}

}  // namespace

double twilight_zenith_s10(double sun_altitude_rad) {
  return s10_of_mag_per_arcsec2(zenith_mag_per_arcsec2(-sun_altitude_rad / deg));
}

double twilight_pattern(double sin_altitude, double angle_from_sun_rad, double k_v) {
  const double s = std::clamp(sin_altitude, 0.0, 1.0);
  const double zenith_distance_deg = std::acos(s) / deg;
  const double k = std::max(k_v, 0.05);
  return light_of_magnitude(-zenith_distance_deg / (360.0 * k)) /
         std::max(angle_from_sun_rad / deg, 1.0) *
         (1.0 - light_of_magnitude(k * scattering_airmass(s)));
}

const Spectrum& twilight_spectrum() {
  static const Spectrum spectrum = [] {
    // Twilight over sunlight, so that it has the B-V, V-R and V-I of Patat et al. 2006 for a Sun 5
    // deg down.
    const Curve bluing{{300 * nm, 360 * nm, 438 * nm, 545 * nm, 641 * nm, 798 * nm, 1000 * nm},
                       {2.5, 2.4, 2.53, 1.0, 1.36, 1.48, 1.48}};
    Spectrum sun = solar_spectrum();
    for (std::size_t i = 0; i < sun.irradiance.value.size(); ++i)
      sun.irradiance.value[i] *= bluing.at_or_end(sun.irradiance.wavelength_m[i]);
    return sun;
  }();
  return spectrum;
}

}  // namespace dmise
