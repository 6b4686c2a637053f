#include "core/detection/known/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "core/sky/air/airmass.h"
#include "core/wcs/wcs.h"

namespace dmise {

Vec<Gcrs> zenith_of(const FrameHeader& header) {
  const Vec<Gcrs> radial = unit(header.sensor_position_m);
  if (!header.site || !(norm(header.site->position_m) > 0)) return radial;
  const Vec<Itrs> itrs = unit(header.site->position_m);
  const double deflection_rad =
      header.site->latitude_rad - std::atan2(itrs.z, std::hypot(itrs.x, itrs.y));
  const Vec<Gcrs> north = Vec<Gcrs>{0, 0, 1} - radial * radial.z;
  if (!(norm(north) > 1e-9)) return radial;
  return radial * std::cos(deflection_rad) + unit(north) * std::sin(deflection_rad);
}

std::optional<Refraction> refraction_of(const FrameHeader& header) {
  if (!header.site) return std::nullopt;
  const Weather air = header.air.value_or(standard_weather(header.site->height_m));
  if (!(air.pressure_hpa > 0)) return std::nullopt;
  return Refraction(air, header.band.centre_m * 1e6);
}

double extinction_mag(const FrameHeader& header, PixelPosition pixel) {
  if (!header.site || header.extinction_mag_per_airmass == 0.0) return 0.0;
  const double sine = dot(wcs_direction(header.wcs, pixel), zenith_of(header));
  double elevation_rad = std::asin(std::clamp(sine, -1.0, 1.0));
  if (const auto refraction = refraction_of(header))
    elevation_rad = refraction->apparent_from_true_rad(elevation_rad);
  return header.extinction_mag_per_airmass * airmass(elevation_rad);
}

}  // namespace dmise
