#include "core/tracking/batch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "tests/support/tracking_trial.h"

namespace dmise {
namespace {

OrbitState displaced(OrbitState state, double metres, double metres_per_s) {
  state.position_m += Vec<Gcrs>{metres, -metres, metres};
  state.velocity_m_per_s += Vec<Gcrs>{-metres_per_s, metres_per_s, metres_per_s};
  return state;
}

// Over 100 seeds squares of 6 errors and of 114 residuals are as chi-square has it: their means
// are 1 within 3 sigma, 0.17 and 0.04.
TEST(Batch, IsConsistent) {
  const ForceModel forces(ForceSettings{});
  double sum_nees = 0, sum_chi2 = 0;
  const int seeds = 100;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const TrackingTrial trial = tracking_trial(forces, {}, seed);
    const auto fit = fit_orbit(forces, trial.observations, displaced(trial.truth, 20e3, 30));
    ASSERT_TRUE(fit) << seed << " " << fit.reason;
    EXPECT_EQ(fit->degrees_of_freedom, 114);
    sum_nees += nees(fit->estimate, trial.truth) / 6;
    sum_chi2 += fit->chi2 / fit->degrees_of_freedom;
  }
  EXPECT_NEAR(sum_nees / seeds, 1, 0.17);
  EXPECT_NEAR(sum_chi2 / seeds, 1, 0.04);
}

TEST(Batch, FindsExactOrbitsFromFarAway) {
  const ForceModel forces(ForceSettings{});
  TrialSettings exact;
  exact.sigma_rad = 1e-12;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    TrackingTrial trial = tracking_trial(forces, exact, seed);
    for (AngleObservation& o : trial.observations) o.covariance_rad2 = {1e-11, 0, 1e-11};
    const auto fit = fit_orbit(forces, trial.observations, displaced(trial.truth, 200e3, 300));
    ASSERT_TRUE(fit) << seed << " " << fit.reason;
    EXPECT_LT(norm(fit->estimate.state.position_m - trial.truth.position_m), 0.05) << seed;
    EXPECT_LT(norm(fit->estimate.state.velocity_m_per_s - trial.truth.velocity_m_per_s), 1e-3);
  }
}

TEST(Batch, OutliersAreLeftOut) {
  const ForceModel forces(ForceSettings{});
  TrackingTrial trial = tracking_trial(forces, {}, 4);
  for (const std::size_t i : {5u, 17u, 40u}) {
    const SkyTangents tangents = sky_tangents(trial.observations[i].direction);
    trial.observations[i].direction =
        unit(trial.observations[i].direction + 300 * arcsec * tangents.north);
  }
  BatchSettings settings;
  const auto plain = fit_orbit(forces, trial.observations, trial.truth, settings);
  settings.huber_sigma = 3;
  settings.reject_sigma = 6;
  const auto robust = fit_orbit(forces, trial.observations, trial.truth, settings);
  ASSERT_TRUE(plain) << plain.reason;
  ASSERT_TRUE(robust) << robust.reason;
  EXPECT_GT(nees(plain->estimate, trial.truth), 1000);
  EXPECT_LT(nees(robust->estimate, trial.truth), 20);
  EXPECT_EQ(std::count(robust->taken.begin(), robust->taken.end(), false), 3);
  for (const std::size_t i : {5u, 17u, 40u}) EXPECT_FALSE(robust->taken[i]);
}

// However many iterations are left when observations have been rejected, an estimate is of those
// that are taken, its covariance too.
TEST(Batch, EstimatesAreOfTheObservationsThatAreTaken) {
  const ForceModel forces(ForceSettings{});
  TrackingTrial trial = tracking_trial(forces, {}, 4);
  for (const std::size_t i : {5u, 17u, 40u}) {
    AngleObservation& outlier = trial.observations[i];
    const SkyTangents tangents = sky_tangents(outlier.direction);
    outlier.direction = unit(outlier.direction + 300 * arcsec * tangents.north);
  }
  int estimates = 0, refused = 0;
  for (int max_iterations = 1; max_iterations <= 12; ++max_iterations) {
    const auto fit = fit_orbit(forces, trial.observations, displaced(trial.truth, 20e3, 30),
                               {.reject_sigma = 6, .max_iterations = max_iterations});
    if (!fit) {
      ++refused;
      continue;
    }
    ++estimates;
    std::vector<AngleObservation> taken;
    for (std::size_t i = 0; i < fit->taken.size(); ++i)
      if (fit->taken[i]) taken.push_back(trial.observations[i]);
    const auto alone = fit_orbit(forces, taken, fit->estimate.state);
    ASSERT_TRUE(alone) << alone.reason;
    const auto &a = fit->estimate.covariance, &b = alone->estimate.covariance;
    EXPECT_LT((a - b).norm(), 1e-3 * b.norm()) << max_iterations;
  }
  EXPECT_GT(estimates, 0);
  EXPECT_GT(refused, 0);
}

// Drag of a low object over three passes of a day.
TEST(Batch, EstimatesDrag) {
  const ForceModel forces(ForceSettings{});
  const double r = 6.378e6 + 300e3;
  const OrbitState truth{SimTime{}, {r, 0, 0}, {0, 0, std::sqrt(earth_gm_m3_per_s2 / r)}, 0.03, 0};
  std::vector<AngleObservation> seen;
  for (int i = 0; i < 60; ++i) {
    const SimTime time = sim_seconds(i / 20 * 16000 + i % 20 * 15);
    const auto now = propagate(forces, truth, time);
    // A site below it, and one beside.
    const Vec<Gcrs> site = 6.371e6 * unit(now->position_m + Vec<Gcrs>{0, i % 2 ? 4e5 : -3e5, 2e5});
    AngleObservation o = observe(forces, truth, time, site);
    o.covariance_rad2 = {1e-11, 0, 1e-11};
    seen.push_back(o);
  }
  OrbitState start = displaced(truth, 500, 0.5);
  start.drag_m2_per_kg = 0.01;
  BatchSettings settings;
  settings.estimate_drag = true;
  const auto fit = fit_orbit(forces, seen, start, settings);
  ASSERT_TRUE(fit) << fit.reason;
  EXPECT_NEAR(fit->estimate.state.drag_m2_per_kg, 0.03, 1e-4);
  EXPECT_GT(fit->estimate.covariance(drag_row, drag_row), 0);
  EXPECT_EQ(fit->estimate.covariance(srp_row, srp_row), 0);
}

TEST(Batch, RefusesWithAReason) {
  const ForceModel forces(ForceSettings{});
  const TrackingTrial trial = tracking_trial(forces, {}, 2);
  const std::span<const AngleObservation> all = trial.observations;
  EXPECT_EQ(fit_orbit(forces, all.first(2), trial.truth).reason,
            "fewer observations than unknowns");
  OrbitState broken = trial.truth;
  broken.position_m.x = NAN;
  EXPECT_EQ(fit_orbit(forces, all, broken).reason, "the start is not finite or out of range");
  // Three times the same line.
  const std::vector<AngleObservation> same(3, all[0]);
  EXPECT_EQ(fit_orbit(forces, same, trial.truth).reason,
            "the observations do not determine the orbit");
  OrbitState fallen = trial.truth;
  fallen.position_m = fallen.position_m * 0.3;
  EXPECT_EQ(fit_orbit(forces, all, fallen).reason, "the path is within the Earth");
}

}  // namespace
}  // namespace dmise
