#pragma once
#include <cmath>

#include "bench/validation/sky_brightness.h"
#include "core/base/units.h"
#include "core/frames/vec.h"
#include "core/photometry/magnitude.h"

namespace dmise {

// The Sun at 1 au above the air.
inline constexpr double sunlight_v_mag = -26.76, sunlight_lx = 133.1e3;

/// Unit vector by azimuth and altitude.
inline Vec<Enu> towards(double azimuth_deg, double altitude_deg) {
  return from_spherical<Enu>((90 - azimuth_deg) * deg, altitude_deg * deg);
}

/// V magnitude of a square arc second of light [1/sr] over the Sun's.
inline double mag_of_sunlit(double share_per_sr) {
  return sunlight_v_mag + magnitude_of_light(share_per_sr * arcsec * arcsec);
}

/// Sum over the sky of light from a direction times the sine of its altitude [sr].
template <class Light>
double on_a_plane(const Light& light) {
  constexpr int heights = 40, azimuths = 36;
  double sum = 0.0;
  for (int i = 0; i < heights; ++i)
    for (int j = 0; j < azimuths; ++j) {
      const double sine = (i + 0.5) / heights;
      sum += sine * light(std::asin(sine) / deg, (j + 0.5) * 180.0 / azimuths);
    }
  return sum * 2.0 * pi / (heights * azimuths);
}

std::vector<SkyTable> night_sky_tables();
std::vector<SkyTable> day_sky_tables();

}  // namespace dmise
