#include "core/frames/earth_orientation.h"

#include <erfa.h>

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

template <class To, class From>
Rotation<To, From> from_erfa(const double (&m)[3][3]) {
  Rotation<To, From> r;
  for (int i = 0; i < 3; ++i) std::copy(m[i], m[i] + 3, r.m[i].begin());
  return r;
}

// Axes turned eastwards about z by `angle_rad`.
template <class To, class From>
Rotation<To, From> about_z(double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  Rotation<To, From> r;
  r.m = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
  return r;
}

double angle_at(double angle_rad, double rate_rad_per_s, SimTime since) {
  return angle_rad + rate_rad_per_s * since.seconds();
}

}  // namespace

void EarthOrientation::run_on(SimTime t) {
  era_rad = eraAnp(angle_at(era_rad, era_rate_rad_per_s, t - time));
  gmst82_rad = eraAnp(angle_at(gmst82_rad, gmst82_rate_rad_per_s, t - time));
  time = t;
}

Rotation<Itrs, Gcrs> EarthOrientation::itrs_from_gcrs(SimTime t) const {
  const auto tirs_from_cirs = about_z<Tirs, Cirs>(angle_at(era_rad, era_rate_rad_per_s, t - time));
  return itrs_from_tirs * tirs_from_cirs * cirs_from_gcrs;
}

Rotation<Itrs, Teme> EarthOrientation::itrs_from_teme(SimTime t) const {
  return itrs_from_tirs *
         about_z<Tirs, Teme>(angle_at(gmst82_rad, gmst82_rate_rad_per_s, t - time));
}

Rotation<Gcrs, Teme> EarthOrientation::gcrs_from_teme(SimTime t) const {
  return itrs_from_gcrs(t).inverse() * itrs_from_teme(t);
}

Vec<Gcrs> EarthOrientation::velocity_of_fixed_point(const Vec<Itrs>& itrs_m, SimTime t) const {
  const Vec<Tirs> r = itrs_from_tirs.inverse() * itrs_m;
  const Vec<Tirs> v{-era_rate_rad_per_s * r.y, era_rate_rad_per_s * r.x, 0.0};
  return itrs_from_gcrs(t).inverse() * (itrs_from_tirs * v);
}

EarthOrientation earth_orientation(SimTime time, const Tt& tt, const Ut1& ut1,
                                   double polar_motion_x_rad, double polar_motion_y_rad,
                                   Nutation nutation) {
  double x = 0.0, y = 0.0, s = 0.0, m[3][3];
  if (nutation == Nutation::iau2006_2000a)
    eraXys06a(tt.jd1, tt.jd2, &x, &y, &s);
  else
    eraXys00b(tt.jd1, tt.jd2, &x, &y, &s);

  EarthOrientation earth;
  earth.time = time;
  eraC2ixys(x, y, s, m);
  earth.cirs_from_gcrs = from_erfa<Cirs, Gcrs>(m);
  eraPom00(polar_motion_x_rad, polar_motion_y_rad, eraSp00(tt.jd1, tt.jd2), m);
  earth.itrs_from_tirs = from_erfa<Itrs, Tirs>(m);
  earth.era_rad = eraEra00(ut1.jd1, ut1.jd2);
  earth.gmst82_rad = eraGmst82(ut1.jd1, ut1.jd2);
  return earth;
}

EarthOrientation earth_orientation(const Clock& clock, SimTime time, Nutation nutation) {
  const EarthRotationParameters p = clock.earth_rotation(time);
  return earth_orientation(time, clock.tt(time), clock.ut1(time), p.polar_motion_x_rad,
                           p.polar_motion_y_rad, nutation);
}

}  // namespace dmise
