#include "core/sky/bodies/earth_limb.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/sky/bodies/occultation.h"

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

// The tangents of an ellipse from (r, 0) on an axis a and (0, b): tan psi = b / sqrt(r^2 - a^2).
TEST(FromLimb, IsByTheClosedFormOfTangentsOfAnEllipse) {
  const OblateEarth earth;
  const double b = a * (1 - earth.ellipsoid.flattening), r = 7.0e6;
  const double towards_equator = std::asin(a / r),
               towards_pole = std::atan(b / std::sqrt(r * r - a * a));
  const double over_pole = std::atan(a / std::sqrt(r * r - b * b));
  for (const double from_nadir : {0.3, 1.2, 1.6, 2.5}) {
    const double c = std::cos(from_nadir), s = std::sin(from_nadir);
    EXPECT_NEAR(from_limb_rad({0, 0, r}, {0, s, -c}, earth), from_nadir - over_pole, 1e-9);
    EXPECT_NEAR(from_limb_rad({r, 0, 0}, {-c, s, 0}, earth), from_nadir - towards_equator, 1e-9);
  }
  // In that plane, as the limb is farther from the nadir beside it, but for the nearest place.
  EXPECT_NEAR(from_limb_rad({r, 0, 0}, {-std::cos(1.6), 0, std::sin(1.6)}, earth),
              1.6 - towards_pole, 1e-4);
  EXPECT_NEAR(above_limb_rad({r, 0, 0}, {-std::cos(1.6), 0, std::sin(1.6)}, earth),
              1.6 - towards_pole, 1e-9);
  // Away from the Earth it is nearest where it is farthest from the nadir.
  EXPECT_NEAR(from_limb_rad({r, 0, 0}, {1, 0, 0}, earth), pi - towards_equator, 1e-9);
}

// Beside limbs found by bisection in 7200 planes through the Earth's centre.
TEST(FromLimb, IsTheLeastAngleFromWhereLinesBeginToHit) {
  const OblateEarth earth;
  for (int i = 1; i < 12; ++i) {
    const Vec<Gcrs> p = from_spherical<Gcrs>(1.7 * i, 1.5 * std::sin(0.7 * i)) * (6.7e6 + 4e5 * i);
    const Vec<Gcrs> d = from_spherical<Gcrs>(0.3 * i, 1.5 * std::sin(2.1 * i));
    const FreeSight sight(p, earth);
    const Vec<Gcrs> down = unit(p * -1.0), u = unit(cross(down, {0.1, 0.2, 0.9}));
    const Vec<Gcrs> v = cross(down, u);
    double least = pi;
    for (int k = 0; k < 7200; ++k) {
      const Vec<Gcrs> side = u * std::cos(2 * pi * k / 7200) + v * std::sin(2 * pi * k / 7200);
      double low = 0.0, high = pi;  // from the nadir
      for (int n = 0; n < 40; ++n) {
        const double middle = 0.5 * (low + high);
        const Vec<Gcrs> line = down * std::cos(middle) + side * std::sin(middle);
        (sight.clear_direction(line) ? high : low) = middle;
      }
      least = std::min(least, angle_rad(d, down * std::cos(high) + side * std::sin(high)));
    }
    const double signed_rad = sight.clear_direction(d) ? least : -least;
    EXPECT_NEAR(from_limb_rad(p, d, earth), signed_rad, 1e-6) << i;
    EXPECT_LE(std::abs(from_limb_rad(p, d, earth)), std::abs(above_limb_rad(p, d, earth)) + 1e-9);
  }
}

}  // namespace
}  // namespace dmise
