#include "core/sky/air/airmass.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {

double airmass(double apparent_altitude_rad) {
  const double altitude_rad = std::clamp(apparent_altitude_rad, 0.0, pi / 2);
  return 1.0 / (std::sin(altitude_rad) + 0.50572 * std::pow(altitude_rad / deg + 6.07995, -1.6364));
}

double scattering_airmass(double sin_altitude) {
  const double s = std::clamp(sin_altitude, 0.0, 1.0);
  return 1.0 / std::sqrt(1.0 - 0.96 * (1.0 - s * s));
}

}  // namespace dmise
