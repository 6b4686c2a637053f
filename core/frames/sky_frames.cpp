#include "core/frames/sky_frames.h"

#include <cmath>

#include "core/base/units.h"

namespace dmise {

Rotation<Ecliptic, Gcrs> ecliptic_from_gcrs() {
  constexpr double obliquity_rad = 84381.406 * arcsec;
  const double c = std::cos(obliquity_rad), s = std::sin(obliquity_rad);
  Rotation<Ecliptic, Gcrs> r;
  r.m = {{{1, 0, 0}, {0, c, s}, {0, -s, c}}};
  return r;
}

Rotation<Galactic, Gcrs> galactic_from_gcrs() {
  Rotation<Galactic, Gcrs> r;
  r.m = {{{-0.0548755604, -0.8734370902, -0.4838350155},
          {+0.4941094279, -0.4448296300, +0.7469822445},
          {-0.8676661490, -0.1980763734, +0.4559837762}}};
  return r;
}

}  // namespace dmise
