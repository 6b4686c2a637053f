#include "core/instrument/pointing_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

constexpr double rounding = 4e-15;

void expect_near(const Vec<CameraFrame>& a, const Vec<CameraFrame>& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

// What lies where the camera truly points is in the middle of its image.
TEST(PointingError, MovesTheBoresightAlongAGreatCircle) {
  for (const auto& [x, y] : {std::pair{0.3, 0.4}, {-1.0, 0.0}, {0.0, 2.0}, {1e-9, -2e-9}}) {
    const double away = std::hypot(x, y);
    const Vec<CameraFrame> boresight{std::sin(away) * x / away, std::sin(away) * y / away,
                                     std::cos(away)};
    for (const double roll : {0.0, 0.7})
      expect_near(true_from_commanded({x, y, roll}) * boresight, {0, 0, 1}, rounding);
  }
}

// By a small angle stars go to the other side by it.
TEST(PointingError, DisplacesStarsToTheOtherSide) {
  expect_near(true_from_commanded({1e-6, 3e-6, 0}) * Vec<CameraFrame>{0, 0, 1}, {-1e-6, -3e-6, 1.0},
              1e-11);
}

// A right-handed turn about the boresight takes right to down: what was on the right is above.
TEST(PointingError, RollsRightHanded) {
  expect_near(true_from_commanded({0, 0, pi / 2}) * Vec<CameraFrame>{1, 0, 0}, {0, -1, 0},
              rounding);
}

TEST(PointingError, IsNothingWithoutDisplacement) {
  EXPECT_EQ(true_from_commanded({0, 0, 0}), (Rotation<CameraFrame, CameraFrame>{}));
}

TEST(PointingError, SumsBiasDriftAndJitter) {
  PointingError error;
  error.bias_rad = {1, 2, 3};
  error.drift_rad_per_s = {0.1, 0.2, 0.3};
  error.pointing_rms_rad = {10, 20, 30};
  EXPECT_EQ(error.at_rad(sim_seconds(10), {1, -1, 2}), (ImageAxes{12, -16, 66}));
}

TEST(PointingError, StatesWhatLeavingItOutWouldCost) {
  PlanFacts facts;
  facts.pixel_rad = 1e-5;
  facts.fwhm_px = 2.0;  // pixels follow it
  facts.stars = 10;
  facts.pointing_error_rad = 2e-6;
  EXPECT_NEAR(PointingError::error(0, facts).position_px, 0.2, 0.03);
  facts.pointing_error_rad = 2e-5;
  EXPECT_EQ(PointingError::error(0, facts), not_bounded);
}

}  // namespace
}  // namespace dmise
