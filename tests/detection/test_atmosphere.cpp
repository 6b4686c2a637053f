#include "core/detection/atmosphere.h"

#include <gtest/gtest.h>

#include "core/base/units.h"

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

// Reference: Kasten & Young 1989, table: relative airmass 0.9997 at 90 deg, 1.994 at 30 deg altitude.
TEST(Atmosphere, TakesExtinctionTimesTheAirmassOfThePixel) {
  EXPECT_NEAR(extinction_mag(looking(0.0), {0, 0}), 0.2 * 0.9997, 1e-4);
  EXPECT_NEAR(extinction_mag(looking(60 * deg), {0, 0}), 0.2 * 1.994, 2e-4);
}

TEST(Atmosphere, TakesNothingInSpace) {
  FrameHeader h = looking(60 * deg);
  h.site.reset();
  EXPECT_EQ(extinction_mag(h, {0, 0}), 0.0);
}

}  // namespace
}  // namespace dmise
