#include "core/orbit/torque_free.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

struct ReferenceState {
  double time_s;
  Quaternion first_from_now;
  Vec<Body> rate_rad_per_s;
};
struct ReferenceCase {
  std::string what;
  Vec<Body> inertia_kg_m2, rate_rad_per_s;
  std::vector<ReferenceState> states;
};
const std::vector<ReferenceCase> references{
#include "tests/reference/torque_free.inc"
};

Rotation<Body, Body> first_from_now(const TorqueFreeRotation& rotation, double time_s) {
  return rotation_of<Body, Body>(rotation.first_from_now(time_s));
}

/// Greatest angle between the axes of two rotations.
double off_rad(const Rotation<Body, Body>& a, const Rotation<Body, Body>& b) {
  double worst = 0.0;
  for (const Vec<Body>& axis : {Vec<Body>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
    worst = std::max(worst, angle_rad(a * axis, b * axis));
  return worst;
}

Vec<Body> momentum(const TorqueFreeRotation& rotation, double time_s) {
  const Vec<Body> w = rotation.rate_rad_per_s(time_s), &i = rotation.inertia_kg_m2();
  return {i.x * w.x, i.y * w.y, i.z * w.z};
}

// Reference: tests/reference/torque_free.py, scipy's DOP853 with a tolerance of 3e-14.
TEST(TorqueFree, AgreesWithTheIntegrationOfEulersEquations) {
  for (const auto& [what, inertia, rate, states] : references) {
    const TorqueFreeRotation rotation(inertia, rate);
    for (const auto& [time_s, attitude, rate_then] : states) {
      EXPECT_LT(off_rad(first_from_now(rotation, time_s), rotation_of<Body, Body>(attitude)), 5e-11)
          << what << " after " << time_s << " s";
      EXPECT_LT(norm(rotation.rate_rad_per_s(time_s) - rate_then), 5e-11) << what;
    }
  }
}

/// A body of three points on each axis, and a rate: any that there are.
TorqueFreeRotation drawn(std::uint64_t number) {
  std::mt19937_64 rng(number);
  const auto uniform = [&] { return double(rng() >> 11) * 0x1p-53; };
  const double a = std::pow(10, 3 * uniform()), b = std::pow(10, 3 * uniform()), c = uniform() * b;
  return {{a + b, a + c, b + c}, {uniform() - 0.5, uniform() - 0.5, uniform() - 0.5}};
}

TEST(TorqueFree, MomentumAndEnergyStayForYears) {
  for (std::uint64_t n = 0; n < 200; ++n) {
    const TorqueFreeRotation rotation = drawn(n);
    const Vec<Body> start = momentum(rotation, 0.0);
    const double energy = dot(start, rotation.rate_rad_per_s(0.0));
    for (const double t : {-1e3, 0.0, 0.7, 1e2, 1e5, 1e8}) {
      const Vec<Body> now = momentum(rotation, t);
      EXPECT_LT(angle_rad(first_from_now(rotation, t) * now, start), 1e-12) << n << " " << t;
      EXPECT_NEAR(norm(now) / norm(start), 1, 1e-12) << n << " " << t;
      EXPECT_NEAR(dot(now, rotation.rate_rad_per_s(t)) / energy, 1, 1e-12) << n << " " << t;
    }
    EXPECT_LT(off_rad(first_from_now(rotation, 0.0), {}), 1e-14) << n;
  }
}

// The attitude turns by the rate: a symmetric difference of 2e-4 rad, and from any time on as from
// the start.
TEST(TorqueFree, TheRateIsTheDerivativeOfTheAttitudeAndAnyInstantMayBeTheFirst) {
  for (std::uint64_t n = 0; n < 50; ++n) {
    const TorqueFreeRotation rotation = drawn(n);
    const double t = 40.0 * double(n), step_s = 1e-4;
    const auto turned =
        first_from_now(rotation, t - step_s).inverse() * first_from_now(rotation, t + step_s);
    const auto& m = turned.m;
    const Vec<Body> turn{m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]};
    const Vec<Body> rate = rotation.rate_rad_per_s(t);
    EXPECT_LT(norm(turn / (4 * step_s) - rate), 1e-6 * norm(rate)) << n;
    const TorqueFreeRotation later(rotation.inertia_kg_m2(), rate);
    EXPECT_LT(off_rad(first_from_now(rotation, t) * first_from_now(later, 33.0),
                      first_from_now(rotation, t + 33.0)),
              1e-9)
        << n;
  }
}

// The axis of an axisymmetric body goes round the momentum at L / It, and the rate round the axis
// at (1 - Ia / It) wa (Landau & Lifshitz, Mechanics, sections 33 and 36).
TEST(TorqueFree, AnAxisymmetricBodyPrecessesAndSpinsAtTheClosedForm) {
  const TorqueFreeRotation rotation({900, 8000, 8000}, {0.3, 0.2, -0.1});
  EXPECT_NEAR(rotation.rate_period_s(), 2 * pi / ((1 - 900.0 / 8000) * 0.3), 1e-9);
  const Vec<Body> axis{1, 0, 0}, l = momentum(rotation, 0.0);
  const double period_s = 2 * pi * 8000 / norm(l);
  EXPECT_LT(angle_rad(first_from_now(rotation, 1000 * period_s) * axis, axis), 1e-10);
  EXPECT_NEAR(angle_rad(first_from_now(rotation, 0.3 * period_s) * axis, l), angle_rad(axis, l),
              1e-12);
}

// The middle axis is an unstable equilibrium: exactly about it the body stays, a millionth beside
// it it turns over, and on the separatrix it does so once.
TEST(TorqueFree, TheMiddleAxisHoldsOnlyWhatIsExactlyOnIt) {
  const Vec<Body> inertia{1, 2, 2.5};
  const TorqueFreeRotation exact(inertia, {0, 0.2, 0}), beside(inertia, {1e-6, 0.2, 0});
  EXPECT_EQ(exact.rate_rad_per_s(1e9), (Vec<Body>{0, 0.2, 0}));
  EXPECT_TRUE(std::isinf(exact.rate_period_s()));
  const double half_s = beside.rate_period_s() / 2;
  EXPECT_NEAR(beside.rate_rad_per_s(half_s).y, -0.2, 1e-9);
  EXPECT_LT(beside.rate_rad_per_s(0.2 * half_s).y, 0.2);
  // I1 (I1 - I2) w1^2 = I3 (I2 - I3) w3^2 to the bit: 8 (8 - 5) 1 = 3 (5 - 3) 4.
  const TorqueFreeRotation separatrix({8, 5, 3.0}, {0.125, 0, 0.25});
  EXPECT_TRUE(std::isinf(separatrix.rate_period_s()));
  for (const double t : {-1e6, 1e6}) {
    const Vec<Body> rate = separatrix.rate_rad_per_s(t);
    EXPECT_NEAR(std::abs(rate.y), std::sqrt((8 * 0.125 * 0.125 + 3 * 0.25 * 0.25) / 5), 1e-15);
    EXPECT_LT(std::hypot(rate.x, rate.z), 1e-12);
    EXPECT_LT(angle_rad(first_from_now(separatrix, t) * momentum(separatrix, t),
                        momentum(separatrix, 0.0)),
              1e-12);
  }
  EXPECT_NEAR(separatrix.rate_rad_per_s(-1e6).y, -separatrix.rate_rad_per_s(1e6).y, 1e-15);
}

TEST(TorqueFree, NoRateIsTooSmallAndNoBodyBreaksTheTriangle) {
  for (const double tiny : {1e-300, 1e-170, 1e-90, 1e-20}) {
    const TorqueFreeRotation all({1, 2, 2.5}, {tiny, 2 * tiny, -tiny}),
        one({1, 2, 2.5}, {tiny, 0.2, -tiny});
    for (const auto& rotation : {all, one})
      for (const double t : {0.0, 100.0, 1e5})
        EXPECT_NEAR(norm(first_from_now(rotation, t) * Vec<Body>{1, 0, 0}), 1, 1e-14) << tiny;
  }
  EXPECT_TRUE(is_inertia({1, 2, 3}));
  EXPECT_FALSE(is_inertia({1, 2, 3.1}));
  EXPECT_FALSE(is_inertia({0, 2, 2}));
  EXPECT_THROW(TorqueFreeRotation({5, 1, 1}, {0, 0, 1}), Error);
}

}  // namespace
}  // namespace dmise
