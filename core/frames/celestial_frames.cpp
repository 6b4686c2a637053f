#include "core/frames/celestial_frames.h"

#include <erfa.h>

#include <array>

#include "core/base/units.h"

namespace dmise {
namespace {

Vec<Gcrs> rotated(const double (&m)[3][3], const Vec<Gcrs>& v) {
  return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
          m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
          m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

Vec<Gcrs> icrs_of_fk5_2000(const Vec<Gcrs>& v) {
  double hipparcos_from_fk5[3][3], spin[3];
  eraFk5hip(hipparcos_from_fk5, spin);
  return rotated(hipparcos_from_fk5, v);
}

/// Newcomb's precession between Besselian epochs (Kinoshita 1975, SAO Special Report 364).
std::array<double, 2> fk4_1950(double ra_rad, double dec_rad, double equinox_byear) {
  const double from = (equinox_byear - 1850) / 1000, dt = (1950 - equinox_byear) / 1000;
  const double shared = 23035.545 + (139.720 + 0.060 * from) * from;
  const double zeta = (shared + (30.240 - 0.27 * from + 17.995 * dt) * dt) * dt * arcsec;
  const double z = (shared + (109.480 + 0.39 * from + 18.325 * dt) * dt) * dt * arcsec;
  const double theta =
      (20051.12 - (85.29 + 0.37 * from) * from + (-42.65 - 0.37 * from - 41.8 * dt) * dt) * dt *
      arcsec;
  double m[3][3];
  eraIr(m);
  eraRz(-zeta, m);
  eraRy(theta, m);
  eraRz(-z, m);
  return to_spherical(rotated(m, from_spherical<Gcrs>(ra_rad, dec_rad)));
}

}  // namespace

Vec<Gcrs> icrs_of_fk5(double ra_rad, double dec_rad, double equinox_jyear) {
  double zero = 0.0, mjd = 0.0, from_2000[3][3], to_2000[3][3];
  eraEpj2jd(equinox_jyear, &zero, &mjd);
  eraPmat76(zero, mjd, from_2000);
  eraTr(from_2000, to_2000);
  return icrs_of_fk5_2000(rotated(to_2000, from_spherical<Gcrs>(ra_rad, dec_rad)));
}

Vec<Gcrs> icrs_of_fk4(double ra_rad, double dec_rad, double equinox_byear) {
  const auto [ra, dec] = fk4_1950(ra_rad, dec_rad, equinox_byear);
  double ra_2000 = 0.0, dec_2000 = 0.0;
  eraFk45z(ra, dec, equinox_byear, &ra_2000, &dec_2000);
  return icrs_of_fk5_2000(from_spherical<Gcrs>(ra_2000, dec_2000));
}

Vec<Gcrs> icrs_of_galactic(double longitude_rad, double latitude_rad) {
  double ra = 0.0, dec = 0.0;
  eraG2icrs(longitude_rad, latitude_rad, &ra, &dec);
  return from_spherical<Gcrs>(ra, dec);
}

}  // namespace dmise
