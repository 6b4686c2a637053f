#pragma once
#include "core/frames/vec.h"
#include "core/time/julian_date.h"

namespace dmise {

/// Sun, Moon and Earth at one instant, geometric (no light time), ICRS axes.
struct SolarSystem {
  Vec<Gcrs> sun_m;                   // from the Earth's centre
  Vec<Gcrs> moon_m;                  // from the Earth's centre
  Vec<Gcrs> earth_barycentric_m;     // the Earth's centre from the barycentre
  Vec<Gcrs> earth_velocity_m_per_s;  // barycentric
  Vec<Gcrs> moon_velocity_m_per_s;   // from the Earth's centre
};

/// Years that `solar_system` covers.
inline constexpr int ephemeris_first_year = 1900, ephemeris_last_year = 2100;

inline bool ephemeris_covers(const Tt& tt) {
  const double year = 2000.0 + julian_years_since_j2000(tt);
  return year >= ephemeris_first_year && year <= ephemeris_last_year;
}

/// Geometric Sun by the low-precision formulae of the Astronomical Almanac, page C5: 0.01 deg, 1950
/// to 2050.
Vec<Gcrs> sun_by_almanac_m(const Tt& tt);

/// Moon by ERFA eraMoon98 (Meeus after ELP 2000-82): 10 arcsec of longitude, 4 of latitude.
Vec<Gcrs> moon_m(const Tt& tt);
/// Its derivative, by the same.
Vec<Gcrs> moon_velocity_m_per_s(const Tt& tt);

/// Sun and Earth by ERFA eraEpv00: within 13 km (0.02 arcsec of the Sun) and 5 mm/s. Throws `Error`
/// outside 1900 to 2100.
SolarSystem solar_system(const Tt& tt);

/// The bodies `dt_s` later, up to an hour: they go on with their velocities and the pull of
/// Sun, Earth and Moon. After an hour the Sun is within 0.1 arcsec, the Moon within 1 arcsec, the
/// Earth's velocity within 10 mm/s of the ephemeris.
SolarSystem advance(SolarSystem bodies, double dt_s);

}  // namespace dmise
