#include "core/detection/known/mid_exposure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double gm = 3.986004418e14, radius_m = 6378e3;

/// Degrees along the way from `a` to `b` at which `v` lies.
double along_deg(const Vec<Gcrs>& v, const Vec<Gcrs>& a, const Vec<Gcrs>& b) {
  const Vec<Gcrs> towards = unit(b - a * dot(a, b));
  return std::atan2(dot(v, towards), dot(v, a)) / deg;
}

FrameHeader on_the_ground(double exposure_s) {
  FrameHeader h;
  h.exposure_s = exposure_s;
  h.sensor_position_m = {radius_m, 0, 0};
  h.site = SitePlace{};
  return h;
}

/// In the plane of x and y, `way` 1 or -1, over an Earth that stands still.
Vec<Gcrs> seen_at(double altitude_m, double place_rad, double time_s, int way) {
  const double a = radius_m + altitude_m;
  const double turned = place_rad + way * std::sqrt(gm / (a * a * a)) * time_s;
  return unit(Vec<Gcrs>{a * std::cos(turned) - radius_m, a * std::sin(turned), 0});
}

// Closed form: places on a circle at even times. Whichever way the object went.
TEST(MidExposure, IsThatOfACircularOrbitOverASite) {
  double largest_deg = 0.0;
  for (const double altitude_m : {300e3, 800e3, 2000e3, 20200e3, 35786e3})
    for (const double place_rad : {-0.15, -0.05, 0.0, 0.02, 0.12})
      for (const double exposure_s : {1.0, 10.0, 25.0})
        for (const int way : {-1, 1}) {
          const auto at = [&](double t) { return seen_at(altitude_m, place_rad, t, way); };
          const Vec<Gcrs> start = at(-exposure_s / 2), end = at(exposure_s / 2);
          const MidExposure mid = mid_exposure(on_the_ground(exposure_s), start, end, false);
          const double truth_deg = along_deg(at(0), start, end);
          EXPECT_NEAR(along_deg(mid.direction, start, end), truth_deg, 2e-5)
              << altitude_m << " " << place_rad << " " << exposure_s;
          largest_deg =
              std::max(largest_deg, std::abs(truth_deg - along_deg(unit(start + end), start, end)));
        }
  EXPECT_GT(largest_deg, 1.0);
}

// Even straight motion: tan(a) = (y / distance), the middle in angle is atan's mean.
TEST(MidExposure, InSpaceIsTheMiddleWithTheSpreadOfStraightMotion) {
  FrameHeader space = on_the_ground(10);
  space.site.reset();
  for (const double place : {-1.0, -0.4, 0.0, 0.7, 1.0}) {
    const auto at = [&](double t) { return unit(Vec<Gcrs>{1, place + 0.02 * t, 0}); };
    const MidExposure mid = mid_exposure(space, at(-5), at(5), false);
    EXPECT_NEAR(angle_rad(mid.direction, at(0)), std::abs(place) * mid.sigma_rad,
                0.05 * mid.sigma_rad);
  }
}

// Faster than an orbit above the air, cut by the edge, of no length: the middle, and no NaN.
TEST(MidExposure, WithoutAnOrbitIsTheMiddle) {
  const Vec<Gcrs> a{1, 0, 0}, b = unit(Vec<Gcrs>{1, 0.8, 0});
  const auto fast = mid_exposure(on_the_ground(0.1), a, b, false);
  const auto cut = mid_exposure(on_the_ground(20), a, b, true);
  const double arc = angle_rad(a, b);
  EXPECT_NEAR(angle_rad(fast.direction, unit(a + b)), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(fast.sigma_rad, arc * arc / 4);
  EXPECT_DOUBLE_EQ(cut.sigma_rad, arc / 2);
  const auto none = mid_exposure(on_the_ground(20), a, a, false);
  EXPECT_EQ(none.sigma_rad, 0.0);
  EXPECT_NEAR(angle_rad(none.direction, a), 0.0, 1e-12);
  const auto header_of_nothing = mid_exposure(FrameHeader{}, a, b, false);
  EXPECT_TRUE(std::isfinite(header_of_nothing.sigma_rad));
}

}  // namespace
}  // namespace dmise
