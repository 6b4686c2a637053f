#include "core/tracking/propagate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

OrbitState low_orbit() {
  return {SimTime{}, {-2384.46e3, 5729.01e3, 3050.46e3}, {-7361.38, -2985.4, 1643.54}, 0.022, 0.02};
}

double error_m(const OrbitState& a, const OrbitState& b) {
  return norm(a.position_m - b.position_m);
}

// Against the closed form of core/orbit, eccentric and open orbits included.
TEST(TrackingPropagate, TwoBodyMotionIsThatOfKepler) {
  const ForceModel two_body(ForceSettings{.zonals = 0});
  for (const double share : {0.95, 1.0, 1.2, 1.38, std::sqrt(2.0), 1.6})
    for (const double time_s : {-86400.0, 5400.0, 86400.0}) {
      const double r = 8e6, v = share * std::sqrt(earth_gm_m3_per_s2 / r);
      const OrbitState start{SimTime{}, {r, 0, 0}, {0, 0.8 * v, 0.6 * v}};
      if (perigee_m(start) < 6.6e6) continue;
      const auto end = propagate(two_body, start, sim_seconds(time_s));
      ASSERT_TRUE(end) << share << " " << end.reason;
      const TwoBodyState exact =
          propagate_two_body({start.position_m, start.velocity_m_per_s}, time_s);
      EXPECT_LT(norm(end->position_m - exact.position_m), 0.1) << share << " " << time_s;
    }
}

// Regression of the node and turn of the perigee by J2, first order (Vallado, 9-38 and 9-40).
TEST(TrackingPropagate, NodeAndPerigeeTurnAsTheoryHasIt) {
  const ForceModel j2(ForceSettings{.zonals = 2});
  const double a = 7.2e6, e = 0.05, i = 1.1;
  const double p = a * (1 - e * e), n = std::sqrt(earth_gm_m3_per_s2 / (a * a * a));
  const OrbitState start = [&] {
    const double v = std::sqrt(earth_gm_m3_per_s2 / p) * (1 + e);
    return OrbitState{SimTime{}, {a * (1 - e), 0, 0}, {0, v * std::cos(i), v * std::sin(i)}};
  }();
  const int turns = 15;
  const auto node = [](const OrbitState& s) {
    const Vec<Gcrs> h = cross(s.position_m, s.velocity_m_per_s);
    return std::atan2(h.x, -h.y);
  };
  const auto end = propagate(j2, start, sim_seconds(turns * 2 * pi / n));
  ASSERT_TRUE(end) << end.reason;
  const double expected =
      -1.5 * 1.0826261738522e-3 * std::pow(6378136.3 / p, 2) * std::cos(i) * 2 * pi * turns;
  EXPECT_NEAR(node(*end) - node(start), expected, 0.01 * std::fabs(expected));
}

TEST(TrackingPropagate, ThereAndBackIsTheSame) {
  const Clock clock(Utc{2459580.5, 0.0});
  const ForceModel forces(clock, SimTime{}, {.sun_moon = true});
  const auto there = propagate(forces, low_orbit(), sim_seconds(86400));
  ASSERT_TRUE(there) << there.reason;
  const auto back = propagate(forces, *there, SimTime{});
  ASSERT_TRUE(back) << back.reason;
  EXPECT_LT(error_m(*back, low_orbit()), 0.2);
}

// Derivatives against central differences of the path.
TEST(TrackingPropagate, TransitionIsTheDerivativeOfThePath) {
  const Clock clock(Utc{2459580.5, 0.0});
  const ForceModel forces(clock, SimTime{});
  const SimTime to = sim_seconds(3000);
  PropagationSettings fine;
  fine.position_tolerance_m = 1e-6;
  const auto moved = propagate_with_transition(forces, low_orbit(), to, fine);
  ASSERT_TRUE(moved) << moved.reason;
  const double steps[orbit_size] = {10, 10, 10, 0.01, 0.01, 0.01, 1e-3, 1e-3};
  for (int k = 0; k < orbit_size; ++k) {
    OrbitVector up = vector_of(low_orbit()), down = up;
    up[k] += steps[k];
    down[k] -= steps[k];
    const auto a = propagate(forces, state_of(up, SimTime{}), to, fine);
    const auto b = propagate(forces, state_of(down, SimTime{}), to, fine);
    const OrbitVector slope = (vector_of(*a) - vector_of(*b)) / (2 * steps[k]);
    const OrbitVector column = moved->transition.col(k);
    // A step over the shadow's edge is right to a thousandth of what sunlight does.
    const double share = k == srp_row ? 3e-3 : 3e-5;
    EXPECT_LT((slope - column).head<3>().norm(), share * column.head<3>().norm() + 2e-3) << k;
    EXPECT_LT((slope - column).segment<3>(3).norm(), share * column.segment<3>(3).norm() + 2e-6)
        << k;
  }
}

TEST(TrackingPropagate, TransitionsFollowOneAnother) {
  const ForceModel forces(ForceSettings{});
  const auto first = propagate_with_transition(forces, low_orbit(), sim_seconds(700));
  const auto second = propagate_with_transition(forces, first->state, sim_seconds(1500));
  const auto both = propagate_with_transition(forces, low_orbit(), sim_seconds(1500));
  const OrbitMatrix product = second->transition * first->transition;
  EXPECT_LT((product - both->transition).cwiseAbs().maxCoeff(),
            1e-6 * both->transition.cwiseAbs().maxCoeff());
  EXPECT_LT(error_m(second->state, both->state), 1e-3);
}

TEST(TrackingPropagate, LongEccentricArcsKeepTheirEnergy) {
  const ForceModel two_body(ForceSettings{.zonals = 0});
  const double r = 6.7e6, v = std::sqrt(earth_gm_m3_per_s2 / r * (1 + 0.95));
  const OrbitState start{SimTime{}, {r, 0, 0}, {0, v, 0}};
  const auto energy = [](const OrbitState& s) {
    return dot(s.velocity_m_per_s, s.velocity_m_per_s) / 2 -
           earth_gm_m3_per_s2 / norm(s.position_m);
  };
  const auto end = propagate(two_body, start, sim_seconds(30 * 86400.0));
  ASSERT_TRUE(end) << end.reason;
  EXPECT_NEAR(energy(*end) / energy(start), 1, 1e-7);
}

TEST(TrackingPropagate, RefusesWhatHasNoPath) {
  const ForceModel forces(ForceSettings{});
  OrbitState falling = low_orbit();
  falling.velocity_m_per_s = {};
  EXPECT_EQ(propagate(forces, falling, sim_seconds(3600)).reason, "the path enters the Earth");
  OrbitState inside = low_orbit();
  inside.position_m = inside.position_m * 0.5;
  EXPECT_EQ(propagate(forces, inside, sim_seconds(1)).reason, "the path is within the Earth");
  OrbitState broken = low_orbit();
  broken.velocity_m_per_s.y = NAN;
  EXPECT_EQ(propagate(forces, broken, sim_seconds(1)).reason,
            "the state is not finite or out of range");
  PropagationSettings few;
  few.max_steps = 3;
  EXPECT_EQ(propagate(forces, low_orbit(), sim_seconds(86400), few).reason,
            "the path takes too many steps");
  EXPECT_EQ(*propagate(forces, low_orbit(), SimTime{}), low_orbit());
}

// To first order the way there and back is no change.
TEST(TrackingPropagate, CovarianceMovesAlong) {
  const ForceModel forces(ForceSettings{});
  OrbitEstimate estimate{low_orbit()};
  estimate.covariance.diagonal() << 100, 400, 900, 1e-2, 4e-2, 9e-2, 0, 0;
  const auto there = propagate(forces, estimate, sim_seconds(5000));
  ASSERT_TRUE(there) << there.reason;
  const auto back = propagate(forces, *there, SimTime{});
  EXPECT_LT((back->covariance - estimate.covariance).cwiseAbs().maxCoeff(), 1e-2);
}

}  // namespace
}  // namespace dmise
