#include "core/frames/earth_orientation.h"

#include <gtest/gtest.h>

#include "core/base/units.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr double uas = 1e-3 * mas;

// An instant with stated Earth rotation.
struct Instant {
  Tt tt;
  Ut1 ut1;
};
Instant instant(const char* utc, double ut1_minus_utc_s) {
  const Clock clock(parse_utc(utc));
  Ut1 ut1 = clock.ut1({});  // taken for UTC, for want of a file
  ut1.jd2 += ut1_minus_utc_s / day_s;
  return {clock.tt({}), ut1};
}

// Largest angle between the axes of the two.
double turn_rad(const Rotation<Itrs, Gcrs>& a, const Rotation<Itrs, Gcrs>& b) {
  double largest = 0.0;
  for (const Vec<Gcrs>& axis : {Vec<Gcrs>{1, 0, 0}, Vec<Gcrs>{0, 1, 0}, Vec<Gcrs>{0, 0, 1}})
    largest = std::max(largest, angle_rad(a * axis, b * axis));
  return largest;
}

// Reference: ERFA in Python, tests/reference/earth_orientation.py, eraC2t06a and eraC2t00b; the
// latter neglects the TIO locator s', 8.5 microarcseconds at that date.
TEST(EarthOrientation, AgreesWithErfa) {
  const Instant at = instant("2018-01-21T00:00:00Z", 0.2);
  const auto earth = [&](Nutation n) {
    return earth_orientation({}, at.tt, at.ut1, 0.06 * arcsec, 0.27 * arcsec, n);
  };
  const Rotation<Itrs, Gcrs> accurate{
      {{{-0.5012333997496984, 0.8653116594168719, 0.0009005845760378588},
        {-0.8653103945976893, -0.5012342074051549, 0.001479975715062505},
        {0.001732044038069051, -3.747193565214231e-05, 0.999998499308526}}}};
  const Rotation<Itrs, Gcrs> fast{
      {{{-0.5012333997849392, 0.8653116593963487, 0.0009005846814944892},
        {-0.8653103945749305, -0.5012342074406264, 0.001479977008161524},
        {0.001732045209862752, -3.747137868779134e-05, 0.9999984993065173}}}};
  EXPECT_LT(turn_rad(earth(Nutation::iau2006_2000a).itrs_from_gcrs({}), accurate), 0.1 * uas);
  EXPECT_LT(turn_rad(earth(Nutation::iau2000b).itrs_from_gcrs({}), fast), 10 * uas);
  EXPECT_NEAR(earth(Nutation::iau2000b).era_rad, 2.095820823176474, 0.1 * uas);
  EXPECT_NEAR(earth(Nutation::iau2000b).gmst82_rad, 2.099858395035113, 0.1 * uas);
}

// Reference: Vallado, Crawford, Hujsak & Kelso, AIAA 2006-6753, appendix C: the example of
// 2004-04-06.
TEST(EarthOrientation, ReproducesThePublishedTemeExample) {
  const Instant at = instant("2004-04-06T07:51:28.386009Z", -0.4399619);
  const EarthOrientation earth =
      earth_orientation({}, at.tt, at.ut1, -0.140682 * arcsec, 0.333309 * arcsec);
  const Vec<Teme> teme_m{5094180.16210, 6127644.65950, 6380344.53270};
  const Vec<Itrs> itrs_m = earth.itrs_from_teme({}) * teme_m;
  EXPECT_NEAR(itrs_m.x, -1033479.3830, 0.02);
  EXPECT_NEAR(itrs_m.y, 7901295.2754, 0.02);
  EXPECT_NEAR(itrs_m.z, 6380356.5958, 1e-3);
  // GCRF as printed, by the IAU-2000 theory with the observed corrections to the pole.
  const Vec<Gcrs> gcrs_m = earth.gcrs_from_teme({}) * teme_m;
  EXPECT_NEAR(gcrs_m.x, 5102508.959, 0.1);
  EXPECT_NEAR(gcrs_m.y, 6123011.403, 0.1);
  EXPECT_NEAR(gcrs_m.z, 6378136.925, 0.1);
}

TEST(EarthOrientation, RunsOnWithinATickAsIfMadeAnew) {
  const Clock clock(parse_utc("2018-01-20T23:40:00Z"));
  const EarthOrientation start = earth_orientation(clock, {});
  for (const double s : {-60.0, 1.0, 60.0, 600.0}) {
    const SimTime t = sim_seconds(s);
    const EarthOrientation anew = earth_orientation(clock, t);
    EXPECT_LT(turn_rad(start.itrs_from_gcrs(t), anew.itrs_from_gcrs(t)), 2 * uas * std::abs(s));
    EXPECT_NEAR(std::remainder(start.gmst82_rad + start.gmst82_rate_rad_per_s * s - anew.gmst82_rad,
                               2 * pi),
                0.0, 0.1 * mas);
  }
}

// Reference: ERFA in Python, tests/reference/earth_orientation.py: turned cross product.
TEST(EarthOrientation, MovesAFixedPointWithTheEarth) {
  const Instant at = instant("2018-01-21T00:00:00Z", 0.2);
  const EarthOrientation earth = earth_orientation({}, at.tt, at.ut1, 0.06 * arcsec, 0.27 * arcsec);
  const Vec<Gcrs> v = earth.velocity_of_fixed_point({-742e3, -5462e3, 3198e3}, {});
  EXPECT_NEAR(v.x, -152.8189333135331, 1e-6);
  EXPECT_NEAR(v.y, 371.7698892732199, 1e-6);
  EXPECT_NEAR(v.z, 0.2784337916018489, 1e-6);
}

TEST(EarthOrientation, IsARotationWhereverTheClockReaches) {
  const Clock clock(parse_utc("1972-01-01T00:00:00Z"));
  for (int year = 0; year <= 100; year += 5) {
    const Rotation<Itrs, Gcrs> r =
        earth_orientation(clock, sim_seconds(year * 365.25 * day_s)).itrs_from_gcrs({});
    const Rotation<Gcrs, Gcrs> one = r.inverse() * r;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(one.m[i][j], i == j ? 1.0 : 0.0, 1e-14);
  }
}

}  // namespace
}  // namespace dmise
