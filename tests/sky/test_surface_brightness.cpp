#include "core/sky/surface_brightness.h"

#include <gtest/gtest.h>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"

namespace dmise {
namespace {

// 21 mag/arcsec2 is 516 S10; 1 S10 is 27.78 mag/arcsec2. Krisciunas & Schaefer 1991: V = 21.587 at
// the zenith of a dark site is 79.0 nL.
TEST(SurfaceBrightness, Units) {
  EXPECT_NEAR(s10_of_mag_per_arcsec2(21.0), 516, 0.5);
  EXPECT_NEAR(mag_per_arcsec2_of_s10(1.0), 27.78, 0.005);
  EXPECT_NEAR(mag_per_arcsec2_of_s10(s10_of_nanolambert(79.0)), 21.587, 0.002);
}

// 22 mag/arcsec2 over the sky's 1 arcsec2 is a star of V = 22.
TEST(SurfaceBrightness, PhotonsOfOneSquareArcsecond) {
  const double radiance = s10_of_mag_per_arcsec2(22.0) * photons_per_s_m2_sr_of_s10(johnson_v());
  EXPECT_NEAR(radiance * arcsec * arcsec, 8.748e9 * light_of_magnitude(22.0),
              0.005 * 8.748e9 * light_of_magnitude(22.0));
}

TEST(SurfaceBrightness, Presets) {
  EXPECT_EQ(zenith_brightness_named("urban"), 18.0);
  EXPECT_EQ(zenith_brightness_named("suburban"), 20.0);
  EXPECT_EQ(zenith_brightness_named("dark"), 21.9);
  EXPECT_EQ(zenith_brightness_named("space"), 22.0);
  EXPECT_FALSE(zenith_brightness_named("disco"));
}

}  // namespace
}  // namespace dmise
