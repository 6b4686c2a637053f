#include "core/detection/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "core/detection/wcs.h"
#include "core/sky/airmass.h"

namespace dmise {

double extinction_mag(const FrameHeader& header, PixelPosition pixel) {
  if (!header.site || header.extinction_mag_per_airmass == 0.0) return 0.0;
  const double sine =
      dot(wcs_direction(header.wcs, pixel), unit(header.sensor_position_m));
  return header.extinction_mag_per_airmass * airmass(std::asin(std::clamp(sine, -1.0, 1.0)));
}

}  // namespace dmise
