#include "core/sky/earth_limb.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/sky/occultation.h"

namespace dmise {
namespace {

constexpr double a = 6378137.0;

// Two satellites 2400 km apart on a circular orbit 550 km high: the one ahead is 9.97 deg below the
// horizontal (asin(1200/6928.137)), the limb of a sphere 22.99 deg (acos(6378.137/6928.137)).
TEST(AboveLimb, IsThirteenDegreesForATargetOfThePaper) {
  const OblateEarth sphere{.ellipsoid = {a, 0.0}};
  const double r = a + 550e3, ahead = 2 * std::asin(1.2e6 / r);
  const Vec<Gcrs> p{r, 0, 0}, q{r * std::cos(ahead), r * std::sin(ahead), 0};
  const double expected = std::acos(a / r) - std::asin(1.2e6 / r);
  EXPECT_NEAR(above_limb_rad(p, q - p, sphere), expected, 1e-9);
  EXPECT_NEAR(expected / deg, 13.01, 0.005);
  EXPECT_NEAR(above_limb_rad(p, {-1, 0, 0}, sphere), -std::asin(a / r), 1e-9);
  EXPECT_NEAR(above_limb_rad(p, {1, 0, 0}, sphere), pi - std::asin(a / r), 1e-9);
}

// By bisection of the directions between the line and the Earth's centre.
TEST(AboveLimb, OfTheEllipsoidIsWhereLinesBeginToHitIt) {
  const OblateEarth earth;
  for (int i = 1; i < 100; ++i) {
    const Vec<Gcrs> p = from_spherical<Gcrs>(1.7 * i, 1.5 * std::sin(0.7 * i)) * (6.9e6 + 1e5 * i);
    const Vec<Gcrs> d = from_spherical<Gcrs>(0.3 * i, 1.5 * std::sin(2.1 * i));
    const FreeSight sight(p, earth);
    const double angle = above_limb_rad(p, d, earth);
    EXPECT_EQ(angle >= 0, sight.clear_direction(d)) << i;
    if (angle < 0) continue;
    const Vec<Gcrs> down = unit(p * -1.0);
    double low = 0.0, high = 1.0;  // share of the way to the centre
    const auto between = [&](double share) { return unit(d * (1 - share) + down * share); };
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (sight.clear_direction(between(middle)) ? low : high) = middle;
    }
    EXPECT_NEAR(angle, angle_rad(d, between(low)), 1e-7) << i;
  }
}

}  // namespace
}  // namespace dmise
