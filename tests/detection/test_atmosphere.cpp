#include "core/detection/known/atmosphere.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/sky/air/airmass.h"

namespace dmise {
namespace {

/// A camera that looks `zenith_angle_rad` away from the zenith of a site on the equator.
FrameHeader looking(double zenith_angle_rad) {
  FrameHeader h;
  h.extinction_mag_per_airmass = 0.2;
  h.sensor_position_m = {6378137.0, 0.0, 0.0};
  h.site.emplace();
  h.air = Weather{.pressure_hpa = 0.0};  // elevations are apparent ones
  h.wcs.ra_rad = zenith_angle_rad;
  h.wcs.cd_deg = {-0.01, 0.0, 0.0, 0.01};
  return h;
}

// Reference: Kasten & Young 1989, table: relative airmass 0.9997 at 90 deg, 1.994 at 30 deg
// altitude.
TEST(Atmosphere, TakesExtinctionTimesTheAirmassOfThePixel) {
  EXPECT_NEAR(extinction_mag(looking(0.0), {0, 0}), 0.2 * 0.9997, 1e-4);
  EXPECT_NEAR(extinction_mag(looking(60 * deg), {0, 0}), 0.2 * 1.994, 2e-4);
}

// WGS 84 at 45 deg N: the normal of the ellipsoid stands 0.192 deg from the geocentric direction.
// Kasten & Young 1989, formula: airmass 5.586 at 10 deg over the geodetic horizon, 5.49 at 10.192.
TEST(Atmosphere, TheZenithIsTheEllipsoidsNormal) {
  FrameHeader h = looking(0.0);
  const double a = 6378137.0, f = 1 / 298.257223563, phi = 45 * deg, turn = 1.234;
  const double e2 = f * (2 - f), n = a / std::sqrt(1 - e2 * std::sin(phi) * std::sin(phi));
  h.site->latitude_rad = phi;
  h.site->position_m = {n * std::cos(phi), 0.0, n * (1 - e2) * std::sin(phi)};
  h.sensor_position_m = {n * std::cos(phi) * std::cos(turn), n * std::cos(phi) * std::sin(turn),
                         n * (1 - e2) * std::sin(phi)};
  const auto [ra, dec] = to_spherical(zenith_of(h));
  EXPECT_NEAR(ra, turn, 1e-9);
  EXPECT_NEAR(dec, phi, 1e-9);
  h.wcs.ra_rad = turn + pi;  // beyond the pole, 10 deg over the horizon
  h.wcs.dec_rad = 55 * deg;
  EXPECT_NEAR(extinction_mag(h, {0, 0}), 0.2 * 5.586, 0.2 * 0.002);
}

// A star at 5 deg stands 9.9 arcmin higher than without air (Astronomical Almanac, 1010 hPa, 10 C):
// airmass 10.31 at the apparent elevation, 10.58 at the true one.
TEST(Atmosphere, TheAirmassIsThatOfTheApparentElevation) {
  FrameHeader h = looking(85 * deg);
  h.air = Weather{.pressure_hpa = 1010.0, .temperature_c = 10.0};
  EXPECT_NEAR(extinction_mag(h, {0, 0}), 0.2 * airmass((5 + 9.6 / 60) * deg), 0.2 * 0.02);
}

TEST(Atmosphere, TakesNothingInSpace) {
  FrameHeader h = looking(60 * deg);
  h.site.reset();
  EXPECT_EQ(extinction_mag(h, {0, 0}), 0.0);
}

}  // namespace
}  // namespace dmise
