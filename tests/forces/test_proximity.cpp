#include "core/forces/proximity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/orbit/two_body.h"

namespace dmise {
namespace {

MotionState<Gcrs> chief_of(double eccentricity, double true_anomaly_rad = 0.3) {
  return state_of({.periapsis_m = 6978137,
                   .eccentricity = eccentricity,
                   .inclination_rad = 1.7,
                   .raan_rad = 0.4,
                   .argument_of_perigee_rad = 1.1,
                   .true_anomaly_rad = true_anomaly_rad});
}

double mean_motion(const MotionState<Gcrs>& circular) {
  return norm(circular.velocity_m_per_s) / norm(circular.position_m);
}

/// A state whose free motion, by first order, neither drifts nor vanishes.
RelativeState state_at_distance(double distance_m, double n_rad_per_s) {
  return {Vec<Rtn>{0.5, 0.7, -0.4} * distance_m,
          Vec<Rtn>{0.2, -1.0, 0.3} * (distance_m * n_rad_per_s)};
}

TEST(Proximity, DeputiesHaveTheStateThatTheyAreRelativeTo) {
  for (const double e : {0.0, 0.4}) {
    const auto chief = chief_of(e);
    const auto start = state_at_distance(2e4, 1e-3);
    const auto back = relative_state(chief, deputy_state(chief, start));
    EXPECT_LT(norm(back.position_m - start.position_m), 1e-8);
    EXPECT_LT(norm(back.velocity_m_per_s - start.velocity_m_per_s), 1e-11);
    // At rest in the axes it turns with them.
    const auto held = deputy_state(chief, {{0, 100, 0}, {}});
    const double rate = norm(cross(chief.position_m, chief.velocity_m_per_s)) /
                        dot(chief.position_m, chief.position_m);
    EXPECT_NEAR(norm(held.velocity_m_per_s - chief.velocity_m_per_s), 100 * rate, 1e-9);
  }
}

// What Clohessy and Wiltshire leave out is of second order: over three decades of distance the
// difference from two conics is the same multiple of distance^2 / radius.
TEST(Proximity, FirstOrderMissesTwoBodiesBySecondOrder) {
  const auto chief = chief_of(0.0);
  const double n = mean_motion(chief), radius_m = norm(chief.position_m);
  for (const double part : {0.1, 0.5, 1.0, 2.0}) {
    const double t = part * 2 * pi / n;
    std::vector<double> multiples;
    for (const double distance_m : {10.0, 100.0, 1e3, 1e4}) {
      const NaturalMotion exact{state_at_distance(distance_m, n), RelativeDynamics::two_body},
          linear{exact.start, RelativeDynamics::clohessy_wiltshire};
      const double off_m = norm(position_m(linear, chief, t) - position_m(exact, chief, t));
      multiples.push_back(off_m / (distance_m * distance_m / radius_m));
    }
    for (const double multiple : multiples)
      EXPECT_NEAR(multiple / multiples.back(), 1, 0.02) << part;
    EXPECT_GT(multiples.back(), 0.1) << part;
    EXPECT_LT(multiples.back(), 200 * std::max(part, 0.2)) << part;
  }
}

// By two bodies the deputy is on its own conic, whatever the chief's eccentricity.
TEST(Proximity, TwoBodiesAreTwoConics) {
  for (const double e : {0.0, 0.01, 0.6}) {
    const auto chief = chief_of(e);
    const NaturalMotion motion{state_at_distance(5e4, 1e-3)};
    for (const double t : {-500.0, 0.0, 3000.0, 86400.0}) {
      const auto there = propagate_two_body(chief, t);
      const auto deputy = propagate_two_body(deputy_state(chief, motion.start), t);
      EXPECT_LT(norm(there.position_m + gcrs_from_rtn(there, position_m(motion, chief, t)) -
                     deputy.position_m),
                1e-7)
          << e << " " << t;
    }
  }
}

// Against Clohessy and Wiltshire's solution from the state of the ellipse's own derivative.
TEST(Proximity, AnEllipseIsFreeMotionOfTwoToOneAndCloses) {
  const auto chief = chief_of(0.0);
  const double n = mean_motion(chief), period_s = 2 * pi / n;
  const Circumnavigation ellipse{.radial_m = 50,
                                 .normal_m = 30,
                                 .phase_rad = 0.4,
                                 .normal_phase_rad = 1.0,
                                 .centre_transverse_m = -20};
  const Vec<Rtn> start_m = position_m(ellipse, chief, 0.0);
  const Vec<Rtn> slope = {50 * n * std::cos(0.4), -100 * n * std::sin(0.4), 30 * n * std::cos(1.0)};
  double highest_m = 0.0, farthest_m = 0.0;
  for (double t = 0; t <= period_s; t += period_s / 200) {
    const Vec<Rtn> there = position_m(ellipse, chief, t);
    EXPECT_LT(norm(clohessy_wiltshire({start_m, slope}, n, t).position_m - there), 1e-9) << t;
    highest_m = std::max(highest_m, there.x);
    farthest_m = std::max(farthest_m, there.y + 20);
  }
  EXPECT_NEAR(highest_m, 50, 0.01);
  EXPECT_NEAR(farthest_m, 100, 0.02);
  EXPECT_LT(norm(position_m(ellipse, chief, period_s) - start_m), 1e-9);
}

TEST(Proximity, AnEccentricChiefTakesFreeMotionOffTheEllipse) {
  for (const double e : {0.001, 0.01}) {
    const auto chief = chief_of(e, pi / 2);
    const double n = std::sqrt(earth_gm_m3_per_s2 / std::pow(6978137 / (1 - e), 3));
    const Circumnavigation ellipse{.radial_m = 50};
    const NaturalMotion free{{position_m(ellipse, chief, 0.0), {50 * n, 0, 0}}};
    double off_m = 0.0;
    for (double t = 0; t <= 2 * pi / n; t += 60)
      off_m = std::max(off_m, norm(position_m(ellipse, chief, t) - position_m(free, chief, t)));
    EXPECT_NEAR(off_m / (100 * e), 9.3, 0.5) << e;
  }
}

TEST(Proximity, AnApproachIsStraightAndAtItsSpeed) {
  const auto chief = chief_of(0.2);
  const ForcedApproach approach{{0, -1000, 0}, {0, -20, 0}, 0.5, 60};
  EXPECT_EQ(corners_s(approach), (std::vector<double>{60.0, 60.0 + 1960.0}));
  EXPECT_EQ(position_m(approach, chief, -100.0), (Vec<Rtn>{0, -1000, 0}));
  EXPECT_EQ(position_m(approach, chief, 160.0), (Vec<Rtn>{0, -950, 0}));
  EXPECT_EQ(position_m(approach, chief, 1e5), (Vec<Rtn>{0, -20, 0}));
  EXPECT_TRUE(corners_s(ForcedApproach{{0, 1, 0}, {0, 1, 0}}).empty());
}

TEST(Proximity, KnowsWhichMotionsNeedACircle) {
  EXPECT_TRUE(needs_circular_chief(Circumnavigation{.radial_m = 1}));
  EXPECT_TRUE(needs_circular_chief(NaturalMotion{{}, RelativeDynamics::clohessy_wiltshire}));
  EXPECT_FALSE(needs_circular_chief(NaturalMotion{}));
  EXPECT_FALSE(needs_circular_chief(ForcedApproach{}));
  for (const double e : {0.0, 0.01, 0.5, 1.2}) EXPECT_NEAR(eccentricity_of(chief_of(e)), e, 1e-12);
}

}  // namespace
}  // namespace dmise
