#include "core/fusion/live_track.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/tracking/initial/initial_orbit.h"
#include "tests/support/tracking_trial.h"

namespace dmise {
namespace {

const ForceModel forces(ForceSettings{});
constexpr double pd = 0.8, false_per_sr = 20.0;

struct OneTrack {
  explicit OneTrack(std::uint64_t seed) : trial(tracking_trial(forces, {}, seed)) {
    const auto fit = two_site_orbit(forces, std::span(trial.observations).first(6));
    EXPECT_TRUE(fit);
    track.emplace(4, OrbitFilter(forces, fit->estimate, {}), std::nullopt);
  }
  TrackingTrial trial;
  std::optional<LiveTrack> track;
};

// Reference: Musicki, Evans & Stankovic 1994: the odds times 1 - Pd + Pd p(z) / lambda.
TEST(LiveTrack, ADetectionRaisesTheOddsByItsLikelihood) {
  OneTrack one(1);
  double odds = std::exp(one.track->log_odds);
  const AngleObservation& seen = one.trial.observations[6];
  const auto expected = one.track->filter.innovation(seen);
  ASSERT_TRUE(expected);
  odds *= 1 - pd + pd * std::exp(expected->log_likelihood) / false_per_sr;
  ASSERT_TRUE(one.track->take(seen, 7.0, pd, false_per_sr));
  EXPECT_NEAR(one.track->log_odds, std::min(12.0, std::log(odds)), 1e-9);
  EXPECT_NEAR(one.track->existence(), 1 / (1 + 1 / std::exp(one.track->log_odds)), 1e-12);
  EXPECT_EQ(one.track->detections, 1);
  EXPECT_EQ(one.track->last_seen, seen.time);
  EXPECT_EQ(one.track->associated, (std::vector<std::string>{seen.detection_id}));
  EXPECT_NEAR(one.track->innovation_d2, expected->d2, 1e-9);
}

TEST(LiveTrack, EachLookThatSeesNothingLeavesOneMinusPd) {
  OneTrack one(2);
  one.track->log_odds = 3;
  for (const double p : {0.5, 0.9, 0.1}) one.track->miss(p);
  EXPECT_NEAR(one.track->log_odds, 3 + std::log(0.5 * 0.1 * 0.9), 1e-12);
  for (int k = 0; k < 100; ++k) one.track->miss(0.9);
  EXPECT_GT(one.track->existence(), 0.0);  // a number, however small
}

TEST(LiveTrack, WhatTheFilterRefusesChangesNothing) {
  OneTrack one(3);
  AngleObservation wrong = one.trial.observations[6];
  wrong.covariance_rad2 = {};
  const double before = one.track->log_odds;
  one.track->changed = false;
  EXPECT_FALSE(one.track->take(wrong, 7.0, pd, false_per_sr));
  EXPECT_EQ(one.track->log_odds, before);
  EXPECT_EQ(one.track->detections, 0);
  EXPECT_TRUE(one.track->associated.empty());
  EXPECT_FALSE(one.track->changed);
}

// Reference: the inverse square: 5 log10 of the range over 1000 km.
TEST(LiveTrack, ItsBrightnessIsThatAt1000km) {
  OneTrack one(4);
  const AngleObservation& seen = one.trial.observations[6];
  ASSERT_TRUE(one.track->take(seen, 7.0, pd, false_per_sr));
  const double range_m = norm(one.track->filter.estimate().state.position_m - seen.sensor_m);
  EXPECT_NEAR(one.track->magnitude(range_m), 7.0, 1e-12);
  EXPECT_NEAR(one.track->magnitude(10 * range_m), 12.0, 1e-12);
  EXPECT_NEAR(published(*one.track, seen.time).magnitude, 7.0 - 5 * std::log10(range_m / 1e6),
              1e-12);
}

TEST(LiveTrack, IsPublishedAtTheTickWithTheFiltersCovariance) {
  OneTrack one(5);
  const SimTime later = one.trial.observations[6].time + sim_seconds(30);
  const Track told = published(*one.track, later);
  const auto expected = one.track->filter.estimate_at(later);
  ASSERT_TRUE(expected);
  EXPECT_EQ(told.id, 4u);
  EXPECT_EQ(told.time, later);
  EXPECT_EQ(told.position_m, expected->state.position_m);
  EXPECT_EQ(told.covariance[0], expected->covariance(0, 0));
  EXPECT_EQ(told.covariance[19], expected->covariance(5, 4));
  EXPECT_EQ(told.covariance[20], expected->covariance(5, 5));
}

TEST(LiveTrack, DetectionsWithoutAMagnitudeLeaveItsMean) {
  MeanBrightness brightness;
  EXPECT_FALSE(brightness.is_known());
  brightness.add(no_magnitude, 5e5);
  EXPECT_FALSE(brightness.is_known());
  brightness.add(6.0, 1e6);
  brightness.add(no_magnitude, 5e5);
  brightness.add(8.0, 1e6);
  EXPECT_NEAR(brightness.magnitude(1e6), 7.0, 1e-12);
  EXPECT_NEAR(brightness.magnitude(1e7), 12.0, 1e-12);
}

}  // namespace
}  // namespace dmise
