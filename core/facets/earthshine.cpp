#include "core/facets/earthshine.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {

std::vector<LightSource> earthshine_sources(const Earthshine& earthshine, const Vec<Body>& earth_m,
                                            const Vec<Body>& to_sun) {
  constexpr double radius_m = 6371e3;
  const double distance_m = norm(earth_m);
  if (!(distance_m > radius_m)) throw Error("earthshine: object is inside the Earth");
  const Vec<Body> down = earth_m / distance_m;
  const auto [u, v] = axes_across(down);
  // Rings of equal width in the squared sine of the angle from the nadir, the weight of light on a
  // plate that faces the Earth.
  const double limb2 = radius_m * radius_m / (distance_m * distance_m);
  const int patches = 4 * earthshine.rings;
  std::vector<LightSource> sources;
  for (int i = 0; i < earthshine.rings; ++i) {
    const double sin2 = limb2 * (i + 0.5) / earthshine.rings;
    const double c = std::sqrt(1.0 - sin2), s = std::sqrt(sin2);
    const double solid_angle_sr = pi * limb2 / earthshine.rings / c / patches;
    const double range_m = distance_m * (c - std::sqrt(std::max(0.0, limb2 - sin2)));
    for (int j = 0; j < patches; ++j) {
      const double azimuth = 2.0 * pi * (j + 0.5) / patches;
      const Vec<Body> ray = down * c + u * (s * std::cos(azimuth)) + v * (s * std::sin(azimuth));
      const double lit = dot(ray * range_m - earth_m, to_sun) / radius_m;
      if (lit > 0.0) sources.push_back({ray, earthshine.albedo / pi * lit * solid_angle_sr});
    }
  }
  return sources;
}

}  // namespace dmise
