#include "core/orbit/two_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double gm = earth_gm_m3_per_s2;
constexpr double ulp = std::numeric_limits<double>::epsilon();

KeplerElements orbit(double eccentricity, double true_anomaly_rad = 0.7) {
  return {.periapsis_m = 7.0e6,
          .eccentricity = eccentricity,
          .inclination_rad = 0.9,
          .raan_rad = 1.3,
          .argument_of_perigee_rad = 2.1,
          .true_anomaly_rad = true_anomaly_rad};
}

double energy(const TwoBodyState& s) {
  return dot(s.velocity_m_per_s, s.velocity_m_per_s) / 2 - gm / norm(s.position_m);
}
double energy_scale(const TwoBodyState& s) {
  return dot(s.velocity_m_per_s, s.velocity_m_per_s) / 2 + gm / norm(s.position_m);
}

/// Energy, in units of v^2/2 + gm/r where it is greatest, and angular momentum, in units of r v.
void expect_conserved(const TwoBodyState& a, const TwoBodyState& b, double tolerance) {
  EXPECT_LE(std::abs(energy(b) - energy(a)),
            tolerance * std::max(energy_scale(a), energy_scale(b)));
  const double moment = std::max(norm(a.position_m) * norm(a.velocity_m_per_s),
                                 norm(b.position_m) * norm(b.velocity_m_per_s));
  EXPECT_LE(norm(cross(b.position_m, b.velocity_m_per_s) - cross(a.position_m, a.velocity_m_per_s)),
            tolerance * moment);
}

double period_s(const TwoBodyState& s) { return 2 * pi * gm / std::pow(-2 * energy(s), 1.5); }

// Reference: Vallado, Fundamentals of Astrodynamics and Applications, example 2-4 (printed to 0.1
// m).
TEST(TwoBody, AgreesWithAPublishedExample) {
  const TwoBodyState start{{1131340.0, -2282343.0, 6672423.0}, {-5643.05, 4303.33, 2428.79}};
  const TwoBodyState end = propagate_two_body(start, 40 * 60, 398600.4418e9);
  EXPECT_NEAR(end.position_m.x, -4219752.7, 0.1);
  EXPECT_NEAR(end.position_m.y, 4363029.2, 0.1);
  EXPECT_NEAR(end.position_m.z, -3958766.6, 0.1);
  EXPECT_NEAR(end.velocity_m_per_s.x, 3689.866, 1e-3);
  EXPECT_NEAR(end.velocity_m_per_s.y, -1916.735, 1e-3);
  EXPECT_NEAR(end.velocity_m_per_s.z, -6112.511, 1e-3);
}

TEST(TwoBody, EnergyAndMomentumHoldAfter1e5Turns) {
  for (const double e : {0.0, 1e-10, 1e-3, 0.1, 0.5, 0.9}) {
    const TwoBodyState start = state_of(orbit(e));
    const double period = period_s(start);
    expect_conserved(start, propagate_two_body(start, 1e5 * period), 1e-12);
    expect_conserved(start, propagate_two_body(start, -1e5 * period), 1e-12);
    TwoBodyState step = start;  // and when every turn starts from the rounded end of the last
    for (int k = 0; k < 100000; ++k) step = propagate_two_body(step, 1.01 * period);
    expect_conserved(start, step, 1e-12);
  }
}

TEST(TwoBody, EnergyAndMomentumHoldOnEveryConic) {
  for (const double e :
       {1 - 1e-6, 1 - 1e-12, 1 - 1e-15, 1.0, 1 + 1e-15, 1 + 1e-12, 1.001, 2.0, 50.0}) {
    for (const double anomaly : {0.0, 0.7, -1.6}) {
      if (1 + e * std::cos(anomaly) <= 0) continue;
      const TwoBodyState start = state_of(orbit(e, anomaly));
      for (const double dt_s : {1e-3, 60.0, 5000.0, 1e6, 1e9, -60.0, -5000.0, -1e9}) {
        SCOPED_TRACE(testing::Message() << e << " " << anomaly << " " << dt_s);
        expect_conserved(start, propagate_two_body(start, dt_s), 1e-12);
      }
    }
  }
}

TEST(TwoBody, NearParabolicEllipseStartedAtItsApogeeComesBackToItsPerigee) {
  // e = 1 - 1e-12 from the apogee: perigee and speed there follow from the momentum alone.
  const double apogee_m = 4e8, e = 1 - 1e-12, perigee_m = apogee_m * (1 - e) / (1 + e);
  const double speed = std::sqrt(gm * (1 - e) / apogee_m);
  const TwoBodyState start{{apogee_m, 0, 0}, {0, speed, 0}};
  const TwoBodyState end = propagate_two_body(start, period_s(start) / 2 * (1 - 1e-9));
  EXPECT_TRUE(std::isfinite(end.position_m.x));
  expect_conserved(start, end, 1e-12);
  EXPECT_GT(norm(end.position_m), perigee_m * (1 - 1e-9));
}

// Going forth and back meets the start again but for the last digit of the state between, which
// makes 1.5 n t of it in phase. On an ellipse that digit weighs (3 a/r - 1)/2 times as much as on a
// circle.
TEST(TwoBody, TimeReversalIsLimitedByTheRoundingOfTheState) {
  for (const double e : {0.0, 1e-10, 1e-3, 0.1, 0.5, 0.9}) {
    const TwoBodyState start = state_of(orbit(e));
    const double period = period_s(start);
    const double n_rad_per_s = 2 * pi / period, a_m = 7e6 / (1 - e);
    for (const double turns : {0.3, 1.7, 100.4, 1e4 + 0.2, 1e5 + 0.45}) {
      const double t_s = turns * period;
      const TwoBodyState middle = propagate_two_body(start, t_s);
      const TwoBodyState back = propagate_two_body(middle, -t_s);
      const double weight = (3 * a_m / norm(middle.position_m) - 1) / 2;
      const double phase_m = norm(start.velocity_m_per_s) / n_rad_per_s;
      const double allowed_m =
          (1.5 * n_rad_per_s * t_s * std::max(1.0, weight) + 4 * weight) * ulp * phase_m;
      EXPECT_LE(norm(back.position_m - start.position_m), allowed_m) << e << " " << turns;
    }
  }
}

// Barker's equation: t = sqrt(2 q^3 / gm) (D + D^3 / 3), D = tan(true anomaly / 2).
TEST(TwoBody, ParabolaFollowsBarkersEquation) {
  const double q_m = 7e6;
  const KeplerElements start{.periapsis_m = q_m, .eccentricity = 1.0};
  for (const double d : {0.01, 0.5, 3.0, 40.0}) {
    const double t_s = std::sqrt(2 * q_m * q_m * q_m / gm) * (d + d * d * d / 3);
    const TwoBodyState end = propagate_two_body(state_of(start), t_s);
    EXPECT_NEAR(norm(end.position_m) / (q_m * (1 + d * d)), 1, 1e-13);
    EXPECT_NEAR(std::atan2(end.position_m.y, end.position_m.x), 2 * std::atan(d), 1e-13);
  }
}

// Free fall from rest at R: t = sqrt(R^3 / (2 gm)) (sqrt(x (1 - x)) + acos(sqrt(x))), x = r / R.
TEST(TwoBody, RadialFallTakesTheTimeOfTheClosedForm) {
  const double top_m = 4.2e7;
  const TwoBodyState start{{0, top_m, 0}, {0, 0, 0}};
  for (const double x : {0.999, 0.5, 0.01, 1e-6}) {
    const double t_s = std::sqrt(top_m * top_m * top_m / (2 * gm)) *
                       (std::sqrt(x * (1 - x)) + std::acos(std::sqrt(x)));
    const TwoBodyState end = propagate_two_body(start, t_s);
    EXPECT_NEAR(end.position_m.y / (x * top_m), 1, x > 1e-3 ? 1e-11 : 1e-6);
    EXPECT_EQ(end.position_m.x, 0.0);
    expect_conserved(start, end, 1e-12);
  }
  // Upwards faster than escape, for 30 years.
  const TwoBodyState up{{7e6, 0, 0}, {12e3, 0, 0}};
  expect_conserved(up, propagate_two_body(up, 1e9), 1e-12);
}

TEST(TwoBody, NoTimeChangesNothing) {
  for (const double e : {0.0, 0.3, 1.0, 3.0}) {
    const TwoBodyState start = state_of(orbit(e)), same = propagate_two_body(start, 0.0);
    EXPECT_LE(norm(same.position_m - start.position_m), 2 * ulp * norm(start.position_m));
    EXPECT_LE(norm(same.velocity_m_per_s - start.velocity_m_per_s),
              2 * ulp * norm(start.velocity_m_per_s));
  }
}

TEST(TwoBody, NonsenseIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(propagate_two_body({{0, 0, 0}, {1, 0, 0}}, 1.0), Error);
  EXPECT_THROW(propagate_two_body({{nan, 0, 0}, {1, 0, 0}}, 1.0), Error);
  EXPECT_THROW(propagate_two_body({{7e6, 0, 0}, {1, 0, 0}}, nan), Error);
  EXPECT_THROW(state_of({.periapsis_m = -1}), Error);
  EXPECT_THROW(state_of({.periapsis_m = 7e6, .eccentricity = -0.1}), Error);
  EXPECT_THROW(state_of({.periapsis_m = 7e6, .eccentricity = 2, .true_anomaly_rad = 3}), Error);
}

}  // namespace
}  // namespace dmise
