#include "core/sky/places/sun_moon.h"

#include <erfa.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

// Geometric longitude and latitude on the mean ecliptic and equinox of date [rad].
std::array<double, 2> ecliptic_of_date(const Vec<Gcrs>& v, const Tt& tt) {
  double m[3][3], p[3] = {v.x, v.y, v.z}, e[3];
  eraEcm06(tt.jd1, tt.jd2, m);
  eraRxp(m, p, e);
  return to_spherical(Vec<Gcrs>{e[0], e[1], e[2]});
}

// Reference: Meeus, Astronomical Algorithms, 2nd ed., example 25.b (VSOP87): 1992-10-13, 0h TD.
TEST(Sun, AgreesWithThePublishedExample) {
  const Tt tt{2448908.5, 0.0};
  const Vec<Gcrs> sun_m = solar_system(tt).sun_m;
  EXPECT_NEAR(ecliptic_of_date(sun_m, tt)[0], 199.907347 * deg, 0.3 * arcsec);
  EXPECT_NEAR(ecliptic_of_date(sun_m, tt)[1], 0.62 * arcsec, 0.3 * arcsec);
  EXPECT_NEAR(norm(sun_m) / au_m, 0.99760775, 2e-6);
  EXPECT_NEAR(ecliptic_of_date(sun_by_almanac_m(tt), tt)[0], 199.907347 * deg, 0.01 * deg);
}

// Reference: Meeus, Astronomical Algorithms, 2nd ed., example 47.a: 1992-04-12, 0h TD.
TEST(Moon, AgreesWithThePublishedExample) {
  const Tt tt{2448724.5, 0.0};
  EXPECT_NEAR(ecliptic_of_date(moon_m(tt), tt)[0], 133.162655 * deg, 1 * arcsec);
  EXPECT_NEAR(ecliptic_of_date(moon_m(tt), tt)[1], -3.229126 * deg, 1 * arcsec);
  EXPECT_NEAR(norm(moon_m(tt)), 368409.7 * km, 0.1 * km);
}

// Reference: the Astronomical Almanac states 0.01 deg from 1950 to 2050 for its formula.
TEST(Sun, ByTheAlmanacIsWhereTheEphemerisHasIt) {
  for (double year = -50; year <= 50; year += 0.37) {
    const Tt tt{2451545.0 + 365.25 * year, 0.0};
    const Vec<Gcrs> by_almanac_m = sun_by_almanac_m(tt), sun_m = solar_system(tt).sun_m;
    EXPECT_LT(angle_rad(by_almanac_m, sun_m), 0.011 * deg) << year;
    EXPECT_NEAR(norm(by_almanac_m) / norm(sun_m), 1.0, 1e-4);
  }
}

TEST(Earth, MovesAsItsPlacesSay) {
  const Tt tt{2458139.5, 0.0};
  const double half_s = 300.0;
  const Vec<Gcrs> slope = (solar_system({tt.jd1, half_s / day_s}).earth_barycentric_m -
                           solar_system({tt.jd1, -half_s / day_s}).earth_barycentric_m) /
                          (2 * half_s);
  EXPECT_LT(norm(slope - solar_system(tt).earth_velocity_m_per_s), 0.1);
}

TEST(Sun, BeyondItsSpanIsAnError) {
  EXPECT_THROW(solar_system({2451545.0 + 36526.0, 0.0}), Error);
  EXPECT_THROW(solar_system({std::nan(""), 0.0}), Error);
}

}  // namespace
}  // namespace dmise
