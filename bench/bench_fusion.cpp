#include "bench/bench_fusion.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/figure.h"
#include "bench/timing.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "core/tracking/filter.h"
#include "core/tracking/initial/initial_orbit.h"
#include "tests/support/tracking_trial.h"

namespace dmise {

namespace {

constexpr int fusion_seeds = 100;
/// Observations from which the filter's start is fitted: two exposures of three sites.
constexpr std::size_t started_by = 6;

template <class T>
T value_of(const Outcome<T>& outcome, const char* what) {
  if (!outcome) throw Error(std::string(what) + ": " + std::string(outcome.reason));
  return *outcome;
}

void bench_triangulation(const ForceModel& forces, bool json) {
  double squares_m2 = 0, sum_nees = 0;
  TrialSettings pair;
  pair.sites = 2;
  pair.exposures = 1;
  for (int seed = 1; seed <= fusion_seeds; ++seed) {
    const TrackingTrial trial = tracking_trial(forces, pair, unsigned(seed));
    const auto position = value_of(triangulate(trial.observations), "triangulate");
    const OrbitState truth = value_of(propagate(forces, trial.truth, position.time), "propagate");
    const Eigen::Vector3d error = eigen_of(position.position_m - truth.position_m);
    squares_m2 += error.squaredNorm() / fusion_seeds;
    sum_nees += error.dot(position.covariance_m2.inverse() * error) / (3 * fusion_seeds);
  }
  print_figure({"triangulation_m", std::sqrt(squares_m2), "m", "", 0, 50, true}, json);
  print_figure({"triangulation_nees", sum_nees, "1", "", 0, 0, true}, json);
}

OrbitFilter started(const ForceModel& forces, const TrackingTrial& trial) {
  const BatchFit start = value_of(
      two_site_orbit(forces, std::span(trial.observations).first(started_by)), "two_site_orbit");
  FilterSettings settings;
  settings.acceleration_noise_m2_per_s3 = 0;
  return OrbitFilter(forces, start.estimate, settings);
}

/// Over all seeds.
struct FilterFigures {
  double squares_m2 = 0, worst_m = 0, nees = 0, innovations = 0, agreement = 0;
};

FilterFigures filter_figures(const ForceModel& forces) {
  FilterFigures out;
  int updates = 0;
  for (int seed = 1; seed <= fusion_seeds; ++seed) {
    const TrackingTrial trial = tracking_trial(forces, {}, unsigned(seed));
    OrbitFilter filter = started(forces, trial);
    for (const AngleObservation& seen : std::span(trial.observations).subspan(started_by)) {
      out.innovations += value_of(filter.update(seen), "update").d2 / 2;
      ++updates;
    }
    const OrbitEstimate end = filter.estimate();
    const OrbitState truth = value_of(propagate(forces, trial.truth, end.state.time), "propagate");
    const double error_m = norm(end.state.position_m - truth.position_m);
    out.squares_m2 += error_m * error_m / fusion_seeds;
    out.worst_m = std::max(out.worst_m, error_m);
    out.nees += nees(end, truth) / (6 * fusion_seeds);
    // Both have seen the same: their difference is that of their approximations.
    const BatchFit batch = value_of(fit_orbit(forces, trial.observations, end.state), "fit_orbit");
    out.agreement = std::max(out.agreement, std::sqrt(nees(batch.estimate, end.state) / 6));
  }
  out.innovations /= updates;
  return out;
}

/// Median time of an update that moves the estimate by `cadence_s` [us].
double update_us(const ForceModel& forces, double cadence_s) {
  TrialSettings settings;
  settings.cadence_s = cadence_s;
  settings.exposures = 10;
  std::vector<double> times_s;
  for (int seed = 1; seed <= fusion_seeds; ++seed) {
    const TrackingTrial trial = tracking_trial(forces, settings, unsigned(seed));
    OrbitFilter filter = started(forces, trial);
    for (std::size_t i = started_by; i < trial.observations.size(); i += 3) {
      const double begin = thread_seconds();
      value_of(filter.update(trial.observations[i]), "update");
      times_s.push_back(thread_seconds() - begin);
    }
  }
  std::nth_element(times_s.begin(), times_s.begin() + long(times_s.size() / 2), times_s.end());
  return 1e6 * times_s[times_s.size() / 2];
}

void print_times(const ForceModel& forces, bool json) {
  print_figure({"filter_update_us", update_us(forces, 10), "us", "", 0, 20, true}, json);
  print_figure({"filter_update_60s_us", update_us(forces, 60), "us", "", 0, 20, true}, json);
  const TrackingTrial trial = tracking_trial(forces, {}, 1);
  const double fit_s = median_seconds(
      21, [&] { value_of(two_site_orbit(forces, trial.observations), "two_site_orbit"); });
  print_figure({"two_site_orbit_ms", fit_s * 1e3, "ms", "", 0, 0, true}, json);
  const double day_s = median_seconds(
      21, [&] { value_of(propagate(forces, trial.truth, sim_seconds(86400.0)), "propagate"); });
  print_figure({"propagate_day_ms", day_s * 1e3, "ms", "", 0, 0, true}, json);
  TrialSettings one_site;
  one_site.sites = 1;
  one_site.exposures = 31;
  const TrackingTrial arc = tracking_trial(forces, one_site, 1);
  const double arc_s = median_seconds(
      5, [&] { value_of(one_arc_orbit(forces, arc.observations), "one_arc_orbit"); });
  print_figure({"one_arc_orbit_ms", arc_s * 1e3, "ms", "", 0, 0, true}, json);
}

}  // namespace

int bench_fusion(bool json) {
  const Clock clock(Utc{2459580.5, 0.0});
  const ForceModel forces(clock, SimTime{});
  bench_triangulation(forces, json);
  const FilterFigures f = filter_figures(forces);
  print_figure({"filter_end_error_m", std::sqrt(f.squares_m2), "m", "", 0, 100, true}, json);
  print_figure({"filter_worst_error_m", f.worst_m, "m", "", 0, 100, true}, json);
  print_figure({"filter_nees", f.nees, "1", "", 0, 1.2, true}, json);
  print_figure({"filter_innovation", f.innovations, "1", "", 0, 1.2, true}, json);
  print_figure({"batch_agrees_sigma", f.agreement, "1", "", 0, 0.2, true}, json);
  print_times(forces, json);
  return 0;
}

}  // namespace dmise
