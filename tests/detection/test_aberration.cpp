#include "core/detection/known/aberration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

// Reference: ERFA 2.0's eraAb, printed by tests/reference/aberration_with_erfa.py (s = 1e30 au, so
// that the Sun's potential is left out).
TEST(Aberration, AgreesWithErfa) {
  struct Case {
    Vec<Gcrs> from, velocity, seen;
  };
  const Case cases[] = {
#include "tests/reference/aberration_values.inc"
  };
  for (const Case& c : cases)
    EXPECT_LT(angle_rad(aberrated(c.from, c.velocity), c.seen), 1e-6 * mas);
}

TEST(Aberration, OppositeVelocityIsTheInverse) {
  const Vec<Gcrs> from = unit(Vec<Gcrs>{0.3, -0.5, 0.7}), velocity = {2.0e4, -1.5e4, -7.0e3};
  EXPECT_LT(angle_rad(aberrated(aberrated(from, velocity), -velocity), from), 1e-7 * mas);
}

// 29.8 km/s across the line of sight: 20.5 arcsec, towards the Earth's motion.
TEST(Aberration, AnnualPartIsUpTo20Arcsec) {
  const Vec<Gcrs> from = {0, 0, 1}, earth = {29784.7, 0, 0}, sensor = {0, 400, 0};
  const Vec<Gcrs> corrected = without_annual_aberration(from, earth, sensor);
  EXPECT_NEAR(angle_rad(from, corrected) / arcsec, 20.49, 0.01);
  EXPECT_GT(corrected.x, 0.0);
}

// What an Earth satellite's light undergoes is the aberration of the sensor's own velocity alone.
// Seen with that and read off stars that show the whole velocity's, it comes back to where it is.
TEST(Aberration, SatelliteReadOffTheStarsComesBack) {
  const Vec<Gcrs> satellite = unit(Vec<Gcrs>{-0.2, 0.9, 0.3});
  const Vec<Gcrs> earth = {-26000, -13500, -5850}, sensor = {4000, -5000, 3500};
  const Vec<Gcrs> seen = aberrated(satellite, sensor);
  const Vec<Gcrs> astrometric = aberrated(seen, -(earth + sensor));
  EXPECT_GT(angle_rad(astrometric, satellite), 5 * arcsec);
  EXPECT_LT(angle_rad(without_annual_aberration(astrometric, earth, sensor), satellite),
            1e-6 * mas);
}

}  // namespace
}  // namespace dmise
