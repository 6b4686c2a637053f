#include "core/fusion/track_start.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/units.h"
#include "core/tracking/propagate.h"
#include "tests/support/tracking_trial.h"

namespace dmise {
namespace {

const ForceModel forces(ForceSettings{});

/// Two sites see one object every 10 s.
TrackingTrial trial_of(std::uint64_t seed, double sigma_arcsec = 5.0) {
  return tracking_trial(
      forces, {.sites = 2, .exposures = 6, .sigma_rad = sigma_arcsec * arcsec, .baseline_m = 400e3},
      seed);
}

/// The sources of exposures `first` to `last` of both sites.
std::vector<LooseSource> sources_of(const TrackingTrial& trial, std::size_t first,
                                    std::size_t last) {
  std::vector<LooseSource> out;
  for (std::size_t i = 2 * first; i < 2 * (last + 1); ++i)
    out.push_back({{trial.observations[i], 8.0, false}, 1.0});
  return out;
}

// Reference: the path that made the observations.
TEST(TrackStart, TwoPlacesOfTwoSitesGiveAnOrbit) {
  int begun = 0;
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TrackingTrial trial = trial_of(seed);
    TrackStart start(forces, {});
    EXPECT_TRUE(start.add(sources_of(trial, 0, 0)).empty());
    const auto orbits = start.add(sources_of(trial, 2, 2));
    if (orbits.empty()) continue;
    ++begun;
    ASSERT_EQ(orbits.size(), 1u);
    EXPECT_EQ(orbits[0].sources.size(), 4u);
    const OrbitEstimate& found = orbits[0].fit.estimate;
    const auto truth = propagate(forces, trial.truth, found.state.time);
    ASSERT_TRUE(truth);
    sum += nees(found, *truth, 3) / 3;
  }
  EXPECT_GE(begun, 19);
  EXPECT_LT(sum / begun, 2.0);
}

TEST(TrackStart, NothingBeginsFromOneSiteOrOnePlace) {
  const TrackingTrial trial = trial_of(3);
  TrackStart start(forces, {});
  std::vector<LooseSource> one_site = sources_of(trial, 0, 5);
  std::erase_if(one_site,
                [](const LooseSource& s) { return s.source.observation.sensor == "site1"; });
  EXPECT_TRUE(start.add(one_site).empty());
  TrackStart other(forces, {});
  EXPECT_TRUE(other.add(sources_of(trial, 0, 0)).empty());
}

TEST(TrackStart, WhatLooksLikeAStarBeginsNothing) {
  const TrackingTrial trial = trial_of(4);
  std::vector<LooseSource> sources = sources_of(trial, 0, 3);
  for (LooseSource& s : sources) s.source.star_like = true;
  TrackStart start(forces, {});
  EXPECT_TRUE(start.add(sources).empty());
  EXPECT_TRUE(start.loose().empty());
}

TEST(TrackStart, PlacesMustLieWithinTheWindow) {
  const TrackingTrial trial = trial_of(5);
  FusionSettings settings;
  settings.start_window_s = 15;
  TrackStart start(forces, settings);
  start.add(sources_of(trial, 0, 0));
  EXPECT_TRUE(start.add(sources_of(trial, 2, 2)).empty());  // 20 s later
  EXPECT_EQ(start.loose().size(), 2u);                      // the first are forgotten
  EXPECT_EQ(start.add(sources_of(trial, 3, 3)).size(), 1u);
}

TEST(TrackStart, WhatIsTakenBeginsNoOther) {
  const TrackingTrial trial = trial_of(6);
  TrackStart start(forces, {});
  start.add(sources_of(trial, 0, 0));
  start.forget({"site0/1/0"});
  EXPECT_TRUE(start.add(sources_of(trial, 2, 2)).empty());
}

// Lines of two objects at each time do not make four orbits, nor one of both.
TEST(TrackStart, OfTwoObjectsEachSourceIsInOneOrbit) {
  const TrackingTrial one = trial_of(7), two = trial_of(8);
  TrackStart start(forces, {});
  std::vector<StartedOrbit> orbits;
  for (std::size_t k = 0; k < 3; ++k) {
    auto sources = sources_of(one, k, k);
    for (LooseSource s : sources_of(two, k, k)) {
      s.source.observation.detection_id += 'b';
      sources.push_back(std::move(s));
    }
    for (StartedOrbit& orbit : start.add(sources)) {
      std::vector<std::string> ids;
      for (const LooseSource& s : orbit.sources) ids.push_back(s.source.observation.detection_id);
      start.forget(ids);
      orbits.push_back(std::move(orbit));
    }
  }
  ASSERT_EQ(orbits.size(), 2u);
  for (const StartedOrbit& orbit : orbits) {
    const auto of_second = std::ranges::count_if(orbit.sources, [](const LooseSource& s) {
      return s.source.observation.detection_id.back() == 'b';
    });
    EXPECT_TRUE(of_second == 0 || of_second == 4) << of_second;
  }
}

}  // namespace
}  // namespace dmise
