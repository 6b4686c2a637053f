#include "core/tracking/initial/triangulate.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/base/units.h"
#include "core/tracking/propagate.h"
#include "tests/support/tracking_trial.h"

namespace dmise {
namespace {

// Errors over their covariance, and their size, at 1 arcsec and 1000 km. The mean of 400 x 3
// squares is 1 +- 0.041.
TEST(Triangulate, IsGoodToFiftyMetresAndHonest) {
  const ForceModel forces(ForceSettings{});
  for (const int sites : {2, 3}) {
    TrialSettings settings;
    settings.sites = sites;
    settings.exposures = 1;
    double squares = 0, sum_nees = 0;
    const int trials = 400;
    for (unsigned seed = 1; seed <= trials; ++seed) {
      const TrackingTrial trial = tracking_trial(forces, settings, seed);
      const auto position = triangulate(trial.observations);
      ASSERT_TRUE(position) << position.reason;
      const auto truth = propagate(forces, trial.truth, position->time);
      const Eigen::Vector3d error = eigen_of(position->position_m - truth->position_m);
      squares += error.squaredNorm();
      sum_nees += error.dot(position->covariance_m2.inverse() * error) / 3;
      EXPECT_EQ(position->degrees_of_freedom, 2 * sites - 3);
    }
    EXPECT_LT(std::sqrt(squares / trials), 50);
    EXPECT_NEAR(sum_nees / trials, 1, 0.17) << sites;
  }
}

// Lines without error meet where the light left, if the velocity is known.
TEST(Triangulate, LightTimeIsInIt) {
  const ForceModel forces(ForceSettings{});
  TrialSettings settings;
  settings.exposures = 1;
  settings.baseline_m = 2000e3;  // ranges, and light times, differ
  const TrackingTrial trial = tracking_trial(forces, settings, 5);
  std::vector<AngleObservation> exact;
  for (const AngleObservation& o : trial.observations) {
    exact.push_back(observe(forces, trial.truth, o.time, o.sensor_m));
    exact.back().covariance_rad2 = o.covariance_rad2;
  }
  const auto position = triangulate(exact, trial.truth.velocity_m_per_s);
  ASSERT_TRUE(position) << position.reason;
  const auto truth = propagate(forces, trial.truth, position->time);
  EXPECT_LT(norm(position->position_m - truth->position_m), 1e-2);
  EXPECT_LT(position->time, SimTime{});
}

TEST(Triangulate, RefusesWhatDoesNotMeet) {
  const auto look = [](const Vec<Gcrs>& from, const Vec<Gcrs>& at) {
    AngleObservation o;
    o.sensor_m = from;
    o.direction = unit(at - from);
    o.covariance_rad2 = {1e-11, 0, 1e-11};
    return o;
  };
  using Lines = std::vector<AngleObservation>;
  const Vec<Gcrs> a{6.37e6, 0, 0}, b{6.3e6, 9e5, 0}, there{7.2e6, 4e5, 1e5};
  EXPECT_TRUE(triangulate(Lines{look(a, there), look(b, there)}));
  EXPECT_EQ(triangulate(Lines{look(a, there)}).reason, "fewer than two lines of sight");
  EXPECT_EQ(triangulate(Lines{look(a, there), look(a, there)}).reason,
            "the lines of sight are nearly parallel");
  EXPECT_EQ(triangulate(Lines{look(a, there), look(there, a * 1.5)}).reason,
            "the lines of sight meet behind a sensor");
  Lines late{look(a, there), look(b, there)};
  late[1].time = sim_seconds(5);
  EXPECT_EQ(triangulate(late).reason, "the lines of sight are too far apart in time");
  EXPECT_EQ(triangulate(Lines{look(a, there), look(b, there + Vec<Gcrs>{0, 0, 2e4})}).reason,
            "the lines of sight miss each other");
  Lines unknown{look(a, there), look(b, there)};
  unknown[0].covariance_rad2 = {};
  EXPECT_EQ(triangulate(unknown).reason, "the covariance is not positive definite");
  EXPECT_EQ(triangulate(Lines{look(a, {2e9, 0, 1}), look(b, {2e9, 0, 1})}).reason,
            "the lines of sight are nearly parallel");
}

}  // namespace
}  // namespace dmise
