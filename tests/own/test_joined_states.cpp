#include "nodes/own/joined_states.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/orbit/motion.h"

namespace dmise {
namespace {

constexpr double radius_m = 7.0e6, rate_rad_per_s = 1.078e-3;
constexpr double spin_rad_per_s = 0.3;

/// A circular orbit in closed form, of an object that spins about z, and one that is away.
ObjectStates on_circle(Tick tick, double t_s) {
  const double u = rate_rad_per_s * t_s, v = radius_m * rate_rad_per_s;
  ObjectStates states{.tick = tick, .time = sim_seconds(t_s), .count = 2};
  states.position_m = {radius_m * std::cos(u), 0, radius_m * std::sin(u), 0, 0, 0};
  states.slope_m_per_s = states.velocity_m_per_s = {-v * std::sin(u), 0, v * std::cos(u), 0, 0, 0};
  states.code = {0, std::uint8_t(MotionCode::untold)};
  states.attitude_object = {0};
  states.gcrs_from_body = {std::cos(spin_rad_per_s * t_s / 2), 0, 0,
                           std::sin(spin_rad_per_s * t_s / 2)};
  states.attitude_rate_rad_per_s = {0, 0, spin_rad_per_s};
  return states;
}

// The cubic on a circle of rate n is off by r (n h)^4 / 384: 0.25 mm for h = 10 s.
TEST(JoinedStates, CubicsFollowAnOrbitAndASpin) {
  const ObjectStates before = on_circle(0, 0.0), after = on_circle(10, 10.0);
  for (Tick tick = 1; tick < 10; ++tick) {
    const ObjectStates is = on_circle(tick, double(tick));
    const ObjectStates joined = joined_states(before, after, tick, sim_seconds(double(tick)));
    EXPECT_EQ(joined.tick, tick);
    EXPECT_EQ(joined.time, is.time);
    EXPECT_LT(norm(joined.position(0) - is.position(0)), 0.26e-3);
    EXPECT_LT(norm(joined.slope(0) - is.slope(0)), 1e-3);
    EXPECT_EQ(joined.velocity_m_per_s, joined.slope_m_per_s);
    ASSERT_TRUE(joined.attitude(0));
    EXPECT_NEAR(joined.attitude(0)->gcrs_from_body.z, is.gcrs_from_body[3], 1e-12);
    EXPECT_NEAR(joined.attitude(0)->rate_rad_per_s.z, spin_rad_per_s, 1e-8);
    EXPECT_NEAR(joined.attitude(0)->rate_rad_per_s.x, 0.0, 1e-8);
    EXPECT_EQ(joined.code[1], std::uint8_t(MotionCode::untold));
    EXPECT_EQ(norm(joined.position(1)), 0.0);
  }
}

// The error of one step of a smooth path is told within some percent by the step of twice its
// length.
TEST(JoinedStates, TheErrorIsThatOfTheClosedForm) {
  const ObjectStates a = on_circle(0, 0.0), b = on_circle(1, 60.0), c = on_circle(2, 120.0);
  const ObjectStates middle = joined_states(a, b, 0, sim_seconds(30.0));
  const double is_m = norm(middle.position(0) - on_circle(0, 30.0).position(0));
  EXPECT_NEAR(cubic_error_m({&a, &b, &c}, 0), is_m, 0.05 * is_m);
  EXPECT_TRUE(std::isinf(cubic_error_m({&a, &b, &c}, 1)));
}

// A burn at the middle state: the cubic before it bends towards the velocity after it.
TEST(JoinedStates, TheErrorOfAJumpOfTheVelocityIsThatOfTheCubicBeforeIt) {
  constexpr double jump_m_per_s = 50.0;
  ObjectStates three[] = {on_circle(0, 0.0), on_circle(1, 1.0), on_circle(2, 2.0)};
  three[1].slope_m_per_s[4] += jump_m_per_s;  // north, of the first of two objects
  three[2].slope_m_per_s[4] += jump_m_per_s;
  three[2].position_m[4] += jump_m_per_s * 1.0;
  double worst_m = 0.0;
  for (double s = 0.02; s < 1.0; s += 0.02) {
    const ObjectStates joined = joined_states(three[0], three[1], 0, sim_seconds(s));
    worst_m = std::max(worst_m, norm(joined.position(0) - on_circle(0, s).position(0)));
  }
  EXPECT_NEAR(worst_m, 7.4, 0.1);
  EXPECT_NEAR(cubic_error_m({&three[0], &three[1], &three[2]}, 0), worst_m, 0.02 * worst_m);
}

}  // namespace
}  // namespace dmise
