#include "core/orbit/attitude_interpolation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/orbit/two_body.h"

namespace dmise {
namespace {

constexpr double half_step_s = 0.125;

/// A low orbit of eccentricity 0.1, and the Sun beside it.
AttitudeScene scene(double t_s) {
  static const TwoBodyState start = state_of(
      {.periapsis_m = 7e6, .eccentricity = 0.1, .inclination_rad = 1.0, .true_anomaly_rad = 0.5});
  const TwoBodyState at = propagate_two_body(start, t_s);
  return {t_s, at.position_m, at.velocity_m_per_s, {0.6 * au_m, 0.7 * au_m, -0.3 * au_m}};
}

AttitudeState state(const Attitude& attitude, double t_s) {
  return attitude_state(attitude, scene(t_s - half_step_s), scene(t_s), scene(t_s + half_step_s));
}

/// Greatest angle [rad] between interpolated and true attitude over ten ticks.
double worst_rad(const Attitude& attitude, double tick_s) {
  double worst = 0.0;
  for (int k = 0; k < 10; ++k) {
    const auto start = state(attitude, k * tick_s), end = state(attitude, (k + 1) * tick_s);
    for (double u = 0.05; u < 1; u += 0.1) {
      const auto between = rotation_of<Gcrs, Body>(interpolate_attitude(u, tick_s, start, end));
      const auto truth = gcrs_from_body(attitude, scene((k + u) * tick_s));
      for (const Vec<Body>& axis : {Vec<Body>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
        worst = std::max(worst, angle_rad(between * axis, truth * axis));
    }
  }
  return worst;
}

TEST(AttitudeInterpolation, ASpinOfManyTurnsATickIsMetExactly) {
  for (const double rpm : {0.1, 7.0, 120.0, -600.0}) {
    SpinningAttitude spin{.axis = {1, 2, -0.5}, .rate_rad_per_s = rpm * 2 * pi / 60};
    spin.gcrs_from_body = rotation_of<Gcrs, Body>({0.5, 0.1, -0.7, 0.2});
    EXPECT_LT(worst_rad(spin, 10.0), 1e-11) << rpm;
  }
}

TEST(AttitudeInterpolation, NadirIsGoodToMicroarcsecondsAndFallsWithTheFourthPower) {
  const double at_10_s = worst_rad(NadirAttitude{}, 10.0),
               at_40_s = worst_rad(NadirAttitude{}, 40.0);
  EXPECT_LT(at_10_s, 1e-5 * arcsec);
  EXPECT_NEAR(std::log2(at_40_s / at_10_s) / 2, 4.0, 0.3);
  EXPECT_LT(worst_rad(SunYawAttitude{}, 10.0), 1e-3 * arcsec);
}

// The error for a tumbling rocket body falls with the fourth power of the tick, and is what
// `worst_interpolation_rad` says.
TEST(AttitudeInterpolation, ATumblingBodyIsMetToTheFourthPowerOfTheTick) {
  const TumblingAttitude tumbling{rotation_of<Gcrs, Body>({0.5, 0.1, -0.7, 0.2}),
                                  TorqueFreeRotation({1900, 7000, 8000}, {0.02, 0.1, -0.05})};
  const double at_1_s = worst_interpolation_rad(tumbling, 1.0),
               at_4_s = worst_interpolation_rad(tumbling, 4.0);
  EXPECT_LT(at_1_s, 2e-6);
  EXPECT_NEAR(std::log2(at_4_s / at_1_s) / 2, 4.0, 0.2);
  EXPECT_LE(worst_rad(tumbling, 4.0), 1.05 * at_4_s);
  EXPECT_GT(worst_rad(tumbling, 4.0), 0.1 * at_4_s);
  const TumblingAttitude steady{{}, TorqueFreeRotation({1, 1, 1}, {0.1, 20.0, -3.0})};
  EXPECT_LT(worst_interpolation_rad(steady, 10.0), 1e-11);
}

TEST(AttitudeInterpolation, InertialStaysToTheBit) {
  const InertialAttitude inertial{rotation_of<Gcrs, Body>({0.6, 0.0, 0.8, 0.0})};
  const auto s = state(inertial, 5.0);
  EXPECT_EQ(norm(s.rate_rad_per_s), 0.0);
  EXPECT_LT(worst_rad(inertial, 100.0), 1e-15);
}

// Local orbital axes turn with the orbit: h / r^2 about its normal.
TEST(AttitudeInterpolation, RateOfNadirIsThatOfTheOrbit) {
  const auto now = scene(100.0);
  const Vec<Gcrs> h = cross(now.position_m, now.velocity_m_per_s);
  const Vec<Gcrs> expected = h / dot(now.position_m, now.position_m);
  EXPECT_LT(norm(state(NadirAttitude{}, 100.0).rate_rad_per_s - expected), 1e-10);
}

TEST(AttitudeInterpolation, TicksThemselvesAreMetInAttitudeAndRate) {
  const auto start = state(NadirAttitude{}, 0.0), end = state(NadirAttitude{}, 60.0);
  for (const auto& [u, expected] : {std::pair{0.0, start}, std::pair{1.0, end}}) {
    const Quaternion q = interpolate_attitude(u, 60.0, start, end), e = expected.gcrs_from_body;
    EXPECT_NEAR(q.w * e.w + q.x * e.x + q.y * e.y + q.z * e.z, 1.0, 1e-14);
  }
  const double du = 1e-5;
  const auto a = rotation_of<Gcrs, Body>(interpolate_attitude(1 - du, 60.0, start, end));
  const auto b = rotation_of<Gcrs, Body>(interpolate_attitude(1, 60.0, start, end));
  const Vec<Body> x{1, 0, 0};
  const Vec<Gcrs> slope = (b * x - a * x) / (60 * du);
  EXPECT_LT(norm(slope - cross(end.rate_rad_per_s, b * x)), 1e-9);
}

}  // namespace
}  // namespace dmise
