#include "core/sky/earth_limb.h"

#include <algorithm>
#include <cmath>

#include "core/sky/occultation.h"

namespace dmise {

double above_limb_rad(const Vec<Gcrs>& from_m, const Vec<Gcrs>& direction,
                      const OblateEarth& earth) {
  // In stretched space the Earth is a sphere, and planes stay planes.
  const Vec<Gcrs> from = earth.stretched(from_m), line = earth.stretched(direction);
  const double distance = norm(from);
  const Vec<Gcrs> down = from * (-1.0 / distance);
  Vec<Gcrs> aside = line - down * dot(line, down);
  if (!(norm(aside) > 1e-12 * norm(line)))  // straight down or up: any side is as near
    aside = cross(down, std::abs(down.z) < 0.9 ? Vec<Gcrs>{0, 0, 1} : Vec<Gcrs>{1, 0, 0});
  const double sine = std::min(1.0, earth.ellipsoid.equatorial_radius_m / distance);
  const Vec<Gcrs> tangent = down * std::sqrt((1.0 - sine) * (1.0 + sine)) + unit(aside) * sine;
  const Vec<Gcrs> limb =
      tangent - earth.pole * (dot(tangent, earth.pole) * earth.ellipsoid.flattening);
  const double angle = angle_rad(direction, limb);
  return FreeSight(from_m, earth).clear_direction(direction) ? angle : -angle;
}

}  // namespace dmise
