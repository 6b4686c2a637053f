#include "core/sky/places/sun_moon.h"

#include <erfa.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/units.h"

namespace dmise {
namespace {

Vec<Gcrs> from_au(const double (&v)[3]) { return Vec<Gcrs>{v[0], v[1], v[2]} * au_m; }
Vec<Gcrs> from_au_per_day(const double (&v)[3]) { return from_au(v) / day_s; }

}  // namespace

Vec<Gcrs> sun_by_almanac_m(const Tt& tt) {
  const double n = (tt.jd1 - 2451545.0) + tt.jd2;  // days since J2000.0
  const double mean_longitude = (280.460 + 0.9856474 * n) * deg;
  const double anomaly = (357.528 + 0.9856003 * n) * deg;
  const double distance_au =
      1.00014 - 0.01671 * std::cos(anomaly) - 0.00014 * std::cos(2 * anomaly);
  const double apparent_longitude =
      mean_longitude + (1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * deg;
  const double longitude = apparent_longitude + 20.5 * arcsec / distance_au;  // less aberration
  const double obliquity = (23.439 - 4e-7 * n) * deg;

  // Mean equator and equinox of date, then back by precession and frame bias.
  double of_date[3] = {std::cos(longitude), std::cos(obliquity) * std::sin(longitude),
                       std::sin(obliquity) * std::sin(longitude)};
  double precession[3][3], gcrs[3];
  eraPmat06(tt.jd1, tt.jd2, precession);
  eraTrxp(precession, of_date, gcrs);
  return from_au(gcrs) * distance_au;
}

Vec<Gcrs> moon_m(const Tt& tt) {
  double pv[2][3];
  eraMoon98(tt.jd1, tt.jd2, pv);
  return from_au(pv[0]);
}

Vec<Gcrs> moon_velocity_m_per_s(const Tt& tt) {
  double pv[2][3];
  eraMoon98(tt.jd1, tt.jd2, pv);
  return from_au_per_day(pv[1]);
}

SolarSystem solar_system(const Tt& tt) {
  if (!ephemeris_covers(tt))
    throw Error(formatted("the Sun's ephemeris covers 1900 to 2100, got %.2f as a year",
                          2000 + julian_years_since_j2000(tt)));

  double heliocentric[2][3], barycentric[2][3];
  eraEpv00(tt.jd1, tt.jd2, heliocentric, barycentric);
  return {.sun_m = -from_au(heliocentric[0]),
          .moon_m = moon_m(tt),
          .earth_barycentric_m = from_au(barycentric[0]),
          .earth_velocity_m_per_s = from_au_per_day(barycentric[1]),
          .moon_velocity_m_per_s = moon_velocity_m_per_s(tt)};
}

SolarSystem advance(SolarSystem s, double dt_s) {
  // Nominal mass parameters of IAU 2015 Resolution B3; the Moon is 1/81.3 of the Earth.
  constexpr double sun_gm_m3_per_s2 = 1.3271244e20;
  constexpr double moon_gm_m3_per_s2 = 3.986004e14 / 81.3;
  constexpr double earth_and_moon_gm_m3_per_s2 = 3.986004e14 + moon_gm_m3_per_s2;
  const auto pull = [](const Vec<Gcrs>& towards_m, double gm_m3_per_s2) {
    const double r_m = norm(towards_m);
    return r_m > 0.0 ? towards_m * (gm_m3_per_s2 / (r_m * r_m * r_m)) : Vec<Gcrs>{};
  };
  const Vec<Gcrs> earth_m_per_s2 =
      pull(s.sun_m, sun_gm_m3_per_s2) + pull(s.moon_m, moon_gm_m3_per_s2);
  const Vec<Gcrs> moon_m_per_s2 = pull(-s.moon_m, earth_and_moon_gm_m3_per_s2);
  const Vec<Gcrs> moved_m = s.earth_velocity_m_per_s * dt_s + earth_m_per_s2 * (0.5 * dt_s * dt_s);
  s.earth_barycentric_m += moved_m;
  s.sun_m += -moved_m;  // the Sun's own 13 m/s about the barycentre are left out
  s.earth_velocity_m_per_s += earth_m_per_s2 * dt_s;
  s.moon_m += s.moon_velocity_m_per_s * dt_s + moon_m_per_s2 * (0.5 * dt_s * dt_s);
  s.moon_velocity_m_per_s += moon_m_per_s2 * dt_s;
  return s;
}

}  // namespace dmise
