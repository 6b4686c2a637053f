#include "core/tracking/filter.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/tracking/initial/initial_orbit.h"
#include "tests/support/tracking_trial.h"

namespace dmise {
namespace {

FilterSettings without_noise() {
  FilterSettings settings;
  settings.acceleration_noise_m2_per_s3 = 0;
  return settings;
}

OrbitFilter started(const ForceModel& forces, const TrackingTrial& trial,
                    const FilterSettings& settings) {
  const auto start = two_site_orbit(forces, std::span(trial.observations).first(6));
  if (!start) throw Error(std::string(start.reason));
  return OrbitFilter(forces, start->estimate, settings);
}

// Errors over their covariance: the mean of 100 x 6 squares is 1 +- 0.058.
TEST(Filter, IsConsistentOverSeeds) {
  const ForceModel forces(ForceSettings{});
  double sum_nees = 0, sum_d2 = 0, squares_m2 = 0;
  int updates = 0;
  const int seeds = 100;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const TrackingTrial trial = tracking_trial(forces, {}, seed);
    OrbitFilter filter = started(forces, trial, without_noise());
    for (const AngleObservation& seen : std::span(trial.observations).subspan(6)) {
      const auto found = filter.update(seen);
      ASSERT_TRUE(found) << found.reason;
      sum_d2 += found->d2 / 2;
      ++updates;
    }
    const OrbitEstimate end = filter.estimate();
    const auto truth = propagate(forces, trial.truth, end.state.time);
    sum_nees += nees(end, *truth) / 6;
    squares_m2 += std::pow(norm(end.state.position_m - truth->position_m), 2);
  }
  EXPECT_NEAR(sum_nees / seeds, 1, 0.2);
  EXPECT_NEAR(sum_d2 / updates, 1, 0.05);
  EXPECT_LT(std::sqrt(squares_m2 / seeds), 100);
}

// The optimum of a nearly linear problem is that of least squares.
TEST(Filter, AgreesWithLeastSquares) {
  const ForceModel forces(ForceSettings{});
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const TrackingTrial trial = tracking_trial(forces, {}, seed);
    OrbitFilter filter = started(forces, trial, without_noise());
    for (const AngleObservation& seen : std::span(trial.observations).subspan(6))
      ASSERT_TRUE(filter.update(seen));
    const OrbitEstimate end = filter.estimate();
    const auto fit = fit_orbit(forces, trial.observations, end.state);
    ASSERT_TRUE(fit) << fit.reason;
    EXPECT_LT(nees(fit->estimate, end.state), 0.01) << seed;
    const OrbitMatrix difference = fit->estimate.covariance - end.covariance;
    EXPECT_LT(difference.topLeftCorner(3, 3).norm(),
              0.01 * fit->estimate.covariance.topLeftCorner(3, 3).norm());
  }
}

/// Distance from a sensor to where the light left the object that arrives at `time_s` after `time`.
double range_m(const ForceModel& forces, const OrbitState& truth, SimTime time, double after_s,
               const Vec<Gcrs>& sensor_m) {
  const auto now = propagate(forces, truth, time, {.position_tolerance_m = 1e-7});
  if (!now) throw Error(std::string(now.reason));
  double light_s = 0;
  Vec<Gcrs> line;
  for (int i = 0; i < 6; ++i) {
    const Vec<Gcrs>& r = now->position_m;
    const Vec<Gcrs> pull = r * (-earth_gm_m3_per_s2 / std::pow(norm(r), 3));
    const double dt_s = after_s - light_s;
    line = r + now->velocity_m_per_s * dt_s + pull * (dt_s * dt_s / 2) - sensor_m;
    light_s = norm(line) / speed_of_light_m_per_s;
  }
  return norm(line);
}

/// Range, and its rate by a difference over 0.2 s, in which a sensor sees an object.
Eigen::Vector2d range_and_rate(const ForceModel& forces, const OrbitState& truth,
                               const AngleObservation& seen) {
  const auto at = [&](double s) {
    return range_m(forces, truth, seen.time, s, seen.sensor_m + seen.sensor_m_per_s * s);
  };
  return {at(0), (at(0.1) - at(-0.1)) / 0.2};
}

/// Adds ranges and their rates, with errors of a seed.
void add_ranges(const ForceModel& forces, TrackingTrial& trial, double sigma_m,
                double sigma_m_per_s, unsigned seed) {
  const RngKey key = rng_key(seed, "filter", 0, "ranges");
  std::uint32_t draw = 0;
  for (AngleObservation& seen : trial.observations) {
    seen.sensor_m_per_s = cross(Vec<Gcrs>{0, 0, 7.292115146706979e-5}, seen.sensor_m);
    const Eigen::Vector2d exact = range_and_rate(forces, trial.truth, seen);
    seen.range_m = {exact[0] + sigma_m * normal_of(rng_word(key, draw++, 0)), sigma_m};
    seen.range_rate_m_per_s = {exact[1] + sigma_m_per_s * normal_of(rng_word(key, draw++, 0)),
                               sigma_m_per_s};
  }
}

/// Fisher information that ranges and their rates have of a state, by differences.
Eigen::Matrix<double, 6, 6> information_of_ranges(const ForceModel& forces, const OrbitState& state,
                                                  std::span<const AngleObservation> observations) {
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (const AngleObservation& seen : observations) {
    Eigen::Matrix<double, 2, 6> slopes;
    for (int i = 0; i < 6; ++i) {
      const double step = i < 3 ? 100.0 : 0.1;  // m, m/s
      OrbitVector there = vector_of(state), here = there;
      there[i] += step, here[i] -= step;
      slopes.col(i) = (range_and_rate(forces, state_of(there, state.time), seen) -
                       range_and_rate(forces, state_of(here, state.time), seen)) /
                      (2 * step);
    }
    slopes.row(0) /= seen.range_m->sigma;
    slopes.row(1) /= seen.range_rate_m_per_s->sigma;
    sum += slopes.transpose() * slopes;
  }
  return sum;
}

// Errors over their covariance: the mean of 60 x 6 squares is 1 +- 0.075.
TEST(Filter, TakesRangesAndTheirRates) {
  const ForceModel forces(ForceSettings{});
  double sum_nees = 0;
  const int seeds = 60;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    TrackingTrial trial = tracking_trial(forces, {}, seed);
    add_ranges(forces, trial, 2.0, 0.05, seed);
    OrbitFilter filter = started(forces, trial, without_noise());
    for (const AngleObservation& seen : std::span(trial.observations).subspan(6)) {
      const auto found = filter.update(seen);
      ASSERT_TRUE(found) << found.reason << " " << seed;
    }
    const OrbitEstimate end = filter.estimate();
    const auto truth = propagate(forces, trial.truth, end.state.time);
    sum_nees += nees(end, *truth) / 6;
  }
  EXPECT_NEAR(sum_nees / seeds, 1, 0.25);
}

// Independent measurements add their information: that of the directions, by least squares, and
// that of ranges and rates make the Cramer-Rao bound, which a nearly linear filter attains.
TEST(Filter, LearnsFromRangesWhatTheyTell) {
  const ForceModel forces(ForceSettings{});
  for (unsigned seed = 1; seed <= 10; ++seed) {
    TrackingTrial trial = tracking_trial(forces, {}, seed);
    const auto end = propagate(forces, trial.truth, trial.observations.back().time);
    ASSERT_TRUE(end);
    const auto fit = fit_orbit(forces, trial.observations, *end);
    ASSERT_TRUE(fit) << fit.reason;
    add_ranges(forces, trial, 2.0, 0.05, seed);
    OrbitFilter filter = started(forces, trial, without_noise());
    const auto after = std::span(trial.observations).subspan(6);
    for (const AngleObservation& seen : after) ASSERT_TRUE(filter.update(seen));
    const OrbitEstimate found = filter.estimate();
    ASSERT_EQ(found.state.time, end->time);
    ASSERT_EQ(fit->estimate.state.time, end->time);
    const Eigen::Matrix<double, 6, 6> of_angles = fit->estimate.covariance.topLeftCorner<6, 6>(),
                                      information = of_angles.inverse() +
                                                    information_of_ranges(forces, *end, after),
                                      bound = information.inverse();
    const auto sigmas = [](const auto& covariance) {
      return covariance.diagonal().array().sqrt().eval();
    };
    const Eigen::Array<double, 6, 1> got = sigmas(found.covariance.topLeftCorner<6, 6>());
    EXPECT_LT((got / sigmas(bound) - 1).abs().maxCoeff(), 0.01) << seed;
    EXPECT_LT((sigmas(bound) / sigmas(of_angles)).minCoeff(), 0.5) << seed;  // they tell much
  }
}

TEST(Filter, RefusesARangeOfAnotherObjectAndStaysAsItWas) {
  const ForceModel forces(ForceSettings{});
  TrackingTrial trial = tracking_trial(forces, {}, 5);
  add_ranges(forces, trial, 2.0, 0.05, 5);
  OrbitFilter filter = started(forces, trial, {});
  ASSERT_TRUE(filter.update(trial.observations[6]));
  const OrbitEstimate before = filter.estimate();
  AngleObservation wrong = trial.observations[7];
  wrong.range_m->value += 50e3;
  EXPECT_FALSE(filter.update(wrong));
  wrong = trial.observations[7];
  wrong.range_rate_m_per_s->value += 500;
  EXPECT_FALSE(filter.update(wrong));
  wrong = trial.observations[7];
  wrong.range_m->sigma = 0;
  EXPECT_FALSE(filter.update(wrong));
  EXPECT_EQ(filter.estimate().state, before.state);
  EXPECT_TRUE(filter.update(trial.observations[7]));
}

TEST(Filter, OrderOfArrivalDoesNotMatter) {
  const ForceModel forces(ForceSettings{});
  const TrackingTrial trial = tracking_trial(forces, {}, 11);
  OrbitFilter in_order = started(forces, trial, {}), shuffled = started(forces, trial, {});
  std::vector<AngleObservation> rest(trial.observations.begin() + 6, trial.observations.end());
  const auto feed = [](OrbitFilter& filter, const std::vector<AngleObservation>& all) {
    for (const AngleObservation& seen : all) ASSERT_TRUE(filter.update(seen));
  };
  feed(in_order, rest);
  const RngKey key = rng_key(3, "filter", 0, "shuffle");
  for (std::size_t i = rest.size() - 1; i > 0; --i)
    std::swap(rest[i], rest[rng_word(key, std::uint32_t(i), 0) % (i + 1)]);
  feed(shuffled, rest);
  EXPECT_EQ(in_order.estimate().state, shuffled.estimate().state);
  EXPECT_EQ(in_order.estimate().covariance, shuffled.estimate().covariance);
}

TEST(Filter, WhatIsTooLateIsRefused) {
  const ForceModel forces(ForceSettings{});
  const TrackingTrial trial = tracking_trial(forces, {}, 12);
  FilterSettings short_memory;
  short_memory.kept = 4;
  OrbitFilter filter = started(forces, trial, short_memory);
  const std::span<const AngleObservation> all = trial.observations;
  for (std::size_t i = 7; i < 30; ++i) ASSERT_TRUE(filter.update(all[i]));
  const OrbitEstimate before = filter.estimate();
  EXPECT_EQ(filter.update(all[6]).reason, "older than what is kept");
  EXPECT_EQ(filter.estimate().state, before.state);
}

TEST(Filter, InnovationLeavesItAsItIs) {
  const ForceModel forces(ForceSettings{});
  const TrackingTrial trial = tracking_trial(forces, {}, 13);
  OrbitFilter filter = started(forces, trial, {});
  for (const AngleObservation& seen : std::span(trial.observations).subspan(6, 30))
    ASSERT_TRUE(filter.update(seen));
  AngleObservation other = trial.observations[36];
  other.direction = unit(other.direction + 1e-3 * sky_tangents(other.direction).east);
  const OrbitEstimate before = filter.estimate();
  const auto innovation = filter.innovation(other);
  ASSERT_TRUE(innovation);
  EXPECT_GT(innovation->d2, 30);
  EXPECT_NEAR(innovation->residual_rad[0], 1e-3, 1e-4);
  EXPECT_EQ(filter.estimate().state, before.state);
  other.covariance_rad2 = {};
  EXPECT_EQ(filter.update(other).reason, "the covariance is not positive definite");
}

// High orbits: one that stays over its sites, and one near the apogee of e = 0.72, for two hours.
// The mean of 2 x 20 x 6 squares is 1 +- 0.09.
TEST(Filter, IsConsistentFarAway) {
  const ForceModel forces(ForceSettings{});
  const OrbitState geostationary{SimTime{}, {4.2164e7, 0, 0}, {0, 3074.6, 0}};
  const OrbitState eccentric{SimTime{}, {4.0e7, 5e6, 2.2e7}, {-500, 1500, 300}};
  double sum_nees = 0;
  for (const OrbitState& truth : {geostationary, eccentric})
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const RngKey key = rng_key(seed, "filter", 0, "far away");
      std::uint32_t count = 0;
      const auto normal = [&] { return double(normal_of(rng_word(key, count++, 0))); };
      std::vector<AngleObservation> seen;
      for (int i = 0; i < 60; ++i) {
        const SimTime time = sim_seconds(i / 2 * 240);
        AngleObservation o =
            observe(forces, truth, time, turned_site(0.6, i % 2 ? -0.3 : 0.4, time));
        const SkyTangents t = sky_tangents(o.direction);
        o.direction = unit(o.direction + arcsec * normal() * t.east + arcsec * normal() * t.north);
        o.covariance_rad2 = {arcsec * arcsec, 0, arcsec * arcsec};
        o.sensor = i % 2 ? "west" : "east";
        seen.push_back(o);
      }
      const auto start = two_site_orbit(forces, std::span(seen).first(12));
      ASSERT_TRUE(start) << start.reason;
      OrbitFilter filter(forces, start->estimate, without_noise());
      for (const AngleObservation& o : std::span(seen).subspan(12)) ASSERT_TRUE(filter.update(o));
      const auto end = propagate(forces, truth, filter.time());
      sum_nees += nees(filter.estimate(), *end) / 6 / 40;
    }
  EXPECT_NEAR(sum_nees, 1, 0.27);
}

// Truth that is pushed at random as the filter believes, over two passes with an hour between.
TEST(Filter, ProcessNoiseIsThatOfThePushes) {
  const ForceModel forces(ForceSettings{});
  const double q = 1e-7;
  FilterSettings settings;
  settings.acceleration_noise_m2_per_s3 = q;
  double sum_nees = 0;
  const int seeds = 60;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const TrackingTrial trial = tracking_trial(forces, {}, seed);
    OrbitFilter filter = started(forces, trial, settings);
    OrbitEstimate start = filter.estimate();
    const RngKey key = rng_key(seed, "filter", 0, "pushes");
    std::uint32_t count = 0;
    const auto normal = [&] { return double(normal_of(rng_word(key, count++, 0))); };
    // The truth begins where the filter thinks it may.
    const Eigen::LLT<Eigen::Matrix<double, 6, 6>> root(start.covariance.topLeftCorner<6, 6>());
    Eigen::Matrix<double, 6, 1> dice;
    for (int k = 0; k < 6; ++k) dice[k] = normal();
    OrbitVector x = vector_of(start.state);
    x.head<6>() += root.matrixL() * dice;
    OrbitState truth = state_of(x, start.state.time);
    const double step_s = 10;
    for (int i = 0; i < 360; ++i) {
      truth = *propagate(forces, truth, truth.time + sim_seconds(step_s));
      const double push = std::sqrt(q * step_s);
      truth.velocity_m_per_s += Vec<Gcrs>{push * normal(), push * normal(), push * normal()};
    }
    const auto believed = filter.estimate_at(truth.time);
    ASSERT_TRUE(believed) << believed.reason;
    sum_nees += nees(*believed, truth) / 6;
  }
  EXPECT_NEAR(sum_nees / seeds, 1, 0.25);
}

TEST(Filter, EstimatesDrag) {
  const ForceModel forces(ForceSettings{});
  const double r = 6.378e6 + 300e3;
  const OrbitState truth{SimTime{}, {r, 0, 0}, {0, 0, std::sqrt(earth_gm_m3_per_s2 / r)}, 0.03, 0};
  OrbitEstimate start{truth};
  start.state.drag_m2_per_kg = 0.02;
  start.state.position_m.x += 30;
  start.covariance.diagonal() << 1e4, 1e4, 1e4, 1e-2, 1e-2, 1e-2, 1e-4, 0;
  OrbitFilter filter(forces, start, without_noise());
  for (int i = 1; i < 60; ++i) {
    const SimTime time = sim_seconds(i / 20 * 16000 + i % 20 * 15);
    const auto now = propagate(forces, truth, time);
    AngleObservation o =
        observe(forces, truth, time,
                6.371e6 * unit(now->position_m + Vec<Gcrs>{0, i % 2 ? 4e5 : -3e5, 2e5}));
    o.covariance_rad2 = {1e-11, 0, 1e-11};
    const auto found = filter.update(o);
    ASSERT_TRUE(found) << i << " " << found.reason;
  }
  EXPECT_NEAR(filter.estimate().state.drag_m2_per_kg, 0.03, 1e-3);
  EXPECT_LT(std::sqrt(filter.estimate().covariance(drag_row, drag_row)), 1e-3);
}

TEST(Filter, RefusesBadStarts) {
  const ForceModel forces(ForceSettings{});
  OrbitEstimate start{{SimTime{}, {7e6, 0, 0}, {0, 7.5e3, 0}}};
  EXPECT_FALSE(OrbitFilter::can_start(start));
  EXPECT_THROW(OrbitFilter(forces, start), Error);  // without a covariance
  start.covariance.diagonal() << 1, 1, 1, 1, 1, 1, 0, 0;
  EXPECT_TRUE(OrbitFilter::can_start(start));
  EXPECT_NO_THROW(OrbitFilter(forces, start));
  start.covariance(0, 1) = start.covariance(1, 0) = 2;
  EXPECT_FALSE(OrbitFilter::can_start(start));
  EXPECT_THROW(OrbitFilter(forces, start), Error);
  start.covariance(0, 1) = start.covariance(1, 0) = NAN;
  EXPECT_FALSE(OrbitFilter::can_start(start));
  EXPECT_THROW(OrbitFilter(forces, start), Error);
}

}  // namespace
}  // namespace dmise
