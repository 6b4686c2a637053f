// Orbits of what one site alone sees.
#include "core/fusion/arc_start.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/base/units.h"
#include "core/tracking/propagate.h"
#include "tests/support/tracking_trial.h"

namespace dmise {
namespace {

const ForceModel forces(ForceSettings{});

TrackingTrial trial_of(std::uint64_t seed, double sigma_arcsec, int exposures = 20) {
  TrialSettings settings;
  settings.sites = 1;
  settings.exposures = exposures;
  settings.sigma_rad = sigma_arcsec * arcsec;
  settings.height_scatter = 0.4;
  return tracking_trial(forces, settings, seed);
}

/// An exposure takes all sources of one second.
LooseSource source_of(const AngleObservation& seen) {
  return {{seen, 8.0, false}, 1.0, std::uint32_t(seen.time.seconds()) + 1};
}

/// Gives the exposures one by one; the first orbits that begin, and when.
std::pair<std::vector<StartedOrbit>, std::size_t> begun(
    ArcStart& start, const std::vector<std::vector<LooseSource>>& exposures) {
  for (std::size_t k = 0; k < exposures.size(); ++k) {
    auto orbits = start.add(exposures[k]);
    if (!orbits.empty()) return {std::move(orbits), k};
  }
  return {};
}

std::vector<std::vector<LooseSource>> exposures_of(const TrackingTrial& trial) {
  std::vector<std::vector<LooseSource>> out;
  for (const AngleObservation& seen : trial.observations) out.push_back({source_of(seen)});
  return out;
}

// Reference: the path that made the observations. Low orbits at 600 to 1,400 km, an exposure every
// 10 s; the errors are told honestly, however large.
TEST(ArcStart, AnArcOfOneSiteGivesAnOrbitWithItsErrors) {
  for (const double sigma_arcsec : {1.0, 20.0}) {
    int found = 0;
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const TrackingTrial trial = trial_of(seed, sigma_arcsec);
      ArcStart start(forces, {});
      const auto [orbits, last] = begun(start, exposures_of(trial));
      if (orbits.empty()) continue;
      ++found;
      ASSERT_EQ(orbits.size(), 1u);
      EXPECT_GE(orbits[0].sources.size(), 4u);
      const OrbitEstimate& estimate = orbits[0].fit.estimate;
      const auto truth = propagate(forces, trial.truth, estimate.state.time);
      ASSERT_TRUE(truth);
      sum += nees(estimate, *truth) / 6;
    }
    EXPECT_GE(found, 3) << sigma_arcsec;
    EXPECT_GT(sum / found, 0.5) << sigma_arcsec;
    EXPECT_LT(sum / found, 1.8) << sigma_arcsec;
  }
}

TEST(ArcStart, LooksOverExposuresInWhichItIsNotFound) {
  auto exposures = exposures_of(trial_of(3, 2.0));
  for (const std::size_t k : {1u, 4u, 5u, 9u}) exposures[k].clear();
  ArcStart start(forces, {});
  EXPECT_EQ(begun(start, exposures).first.size(), 1u);
}

TEST(ArcStart, OfSeveralObjectsEachHasItsOwn) {
  const TrackingTrial one = trial_of(4, 2.0), two = trial_of(5, 2.0);
  ArcStart start(forces, {});
  std::size_t orbits = 0;
  for (std::size_t k = 0; k < one.observations.size(); ++k) {
    LooseSource other = source_of(two.observations[k]);
    other.source.observation.detection_id += 'b';
    for (const StartedOrbit& orbit : start.add({source_of(one.observations[k]), other})) {
      std::vector<std::string> ids;
      for (const LooseSource& s : orbit.sources) ids.push_back(s.source.observation.detection_id);
      const auto of_second =
          std::ranges::count_if(ids, [](const std::string& id) { return id.back() == 'b'; });
      EXPECT_TRUE(of_second == 0 || of_second == long(ids.size())) << of_second;
      start.forget(ids);
      ++orbits;
    }
  }
  EXPECT_GE(orbits, 2u);
}

// Each row of a rolling shutter has its own time: what else an exposure shows is no exposure of its
// own.
TEST(ArcStart, ARollingShuttersExposureIsOne) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  const TrackingTrial trial = trial_of(3, 2.0);
  ArcStart start(forces, {});
  const Vec<Gcrs> up = unit(trial.observations[0].sensor_m);
  std::size_t orbits = 0;
  for (const AngleObservation& truth : trial.observations) {
    std::vector<LooseSource> sources{source_of(truth)};
    while (sources.size() < 9) {
      const Vec<Gcrs> direction = unit(Vec<Gcrs>{normal(random), normal(random), normal(random)});
      if (dot(direction, up) < 0.5) continue;
      LooseSource other = source_of(truth);
      other.source.observation.direction = direction;
      other.source.observation.time.ns += std::int64_t(5'000'000 * sources.size());
      other.source.observation.detection_id += "x" + std::to_string(sources.size());
      sources.push_back(std::move(other));
    }
    orbits += start.add(sources).size();
  }
  EXPECT_GE(orbits, 1u);
}

// Ten false alarms a frame over 60 degrees around the zenith, for half an hour.
TEST(ArcStart, NoiseBeginsNothing) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const TrackingTrial trial = trial_of(1, 2.0, 2);
  ArcStart start(forces, {});
  const Vec<Gcrs> up = unit(trial.observations[0].sensor_m);
  std::size_t orbits = 0;
  for (int k = 0; k < 180; ++k) {
    std::vector<LooseSource> sources;
    while (sources.size() < 10) {
      const Vec<Gcrs> direction = unit(Vec<Gcrs>{normal(random), normal(random), normal(random)});
      if (dot(direction, up) < 0.5) continue;
      AngleObservation seen = trial.observations[0];
      seen.time = sim_seconds(10.0 * k);
      seen.direction = direction;
      seen.covariance_rad2 = {1e-8, 0, 1e-8};  // 20 arcsec
      seen.detection_id = std::to_string(k) + "/" + std::to_string(sources.size());
      sources.push_back({{seen, 8.0, false}, 1 / pi, std::uint32_t(k) + 1});
    }
    orbits += start.add(sources).size();
  }
  EXPECT_EQ(orbits, 0u);
}

TEST(ArcStart, WhatLooksLikeAStarBeginsNothing) {
  auto exposures = exposures_of(trial_of(3, 2.0));
  for (auto& exposure : exposures) exposure[0].source.star_like = true;
  ArcStart start(forces, {});
  EXPECT_TRUE(begun(start, exposures).first.empty());
}

// A hot pixel moves as the stars over a geostationary object's distance allow: its arc leaves the
// range open.
TEST(ArcStart, WhatStandsStillBeginsNothing) {
  const TrackingTrial trial = trial_of(2, 2.0);
  std::vector<std::vector<LooseSource>> exposures;
  for (int k = 0; k < 12; ++k) {
    AngleObservation seen = trial.observations[0];
    seen.time = sim_seconds(10.0 * k);
    seen.sensor_m = turned_site(0.6, 0.0, seen.time);
    seen.direction = unit(turned_site(0.3, 0.1, seen.time));
    seen.detection_id = std::to_string(k);
    exposures.push_back({source_of(seen)});
  }
  ArcStart start(forces, {});
  EXPECT_TRUE(begun(start, exposures).first.empty());
}

}  // namespace
}  // namespace dmise
