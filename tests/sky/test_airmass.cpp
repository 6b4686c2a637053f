#include "core/sky/air/airmass.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

// Kasten & Young 1989, table II: airmass by altitude.
TEST(Airmass, KastenAndYoungsTable) {
  const struct {
    double altitude_deg, airmass;
  } table[] = {{90, 0.9997}, {60, 1.1543}, {30, 1.9939}, {20, 2.9016}, {10, 5.5841},
               {5, 10.3058}, {2, 19.4308}, {1, 26.3130}, {0, 37.9196}};
  for (const auto& [altitude_deg, expected] : table)
    EXPECT_NEAR(airmass(altitude_deg * deg), expected, 1e-3 * expected) << altitude_deg;
}

TEST(Airmass, HeldBelowTheHorizonAndMonotone) {
  EXPECT_EQ(airmass(-0.1), airmass(0.0));
  EXPECT_EQ(airmass(-pi / 2), airmass(0.0));
  double last = 100;
  for (double altitude = -2; altitude <= 90; altitude += 0.01) {
    EXPECT_LE(airmass(altitude * deg), last + 1e-6);  // its minimum lies 0.1 deg off the zenith
    last = airmass(altitude * deg);
  }
  EXPECT_NEAR(scattering_airmass(1.0), 1.0, 1e-12);
  EXPECT_NEAR(scattering_airmass(-0.5), 5.0, 1e-9);
}

}  // namespace
}  // namespace dmise
