#include "sensors/survey/survey_summary.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dmise {
namespace {

SurveyPass pass(std::uint32_t object, double from_s, double to_s, double probability) {
  return {.object = object,
          .first = sim_seconds(from_s),
          .last = sim_seconds(to_s),
          .exposures = 1,
          .expected = probability,
          .log_miss = std::log1p(-probability),
          .best_snr = 10.0};
}

/// Two shells: objects 0 and 1, object 2.
Shells two_shells() {
  Shells shells;
  shells.shells = {{"low", 2}, {"high", 1}};
  shells.of_object = {0, 0, 1};
  return shells;
}

// By hand: object 0 is missed by both sensors with 0.5 x 0.2.
TEST(SurveySummary, DetectedIsByAnySensor) {
  const SensorSurvey a{.sensor = "a", .passes = {pass(0, 0, 60, 0.5), pass(2, 0, 60, 0.25)}};
  const SensorSurvey b{.sensor = "b", .passes = {pass(0, 30, 90, 0.8)}};
  const SurveySummary s = summarise_survey({a, b}, two_shells(), {30, 30}, 1);
  EXPECT_NEAR(s.run.shells[0].detected, 0.9, 1e-12);
  EXPECT_NEAR(s.run.shells[1].detected, 0.25, 1e-12);
  EXPECT_NEAR(s.run.all.detected, 1.15, 1e-12);
  EXPECT_NEAR(s.run.all.detections, 1.55, 1e-12);
  EXPECT_EQ(s.run.shells[0].objects, 2u);
  EXPECT_EQ(s.run.shells[0].covered, 1u);
  EXPECT_EQ(s.run.all.covered, 2u);
  EXPECT_NEAR(s.run.sensors[0].detected, 0.75, 1e-12);
  EXPECT_EQ(s.run.sensors[1].covered, 1u);
  EXPECT_EQ(s.nights.size(), 1u);
  EXPECT_NEAR(s.nights[0].all.detected, 1.15, 1e-12);
}

// Visits of object 0 are from 0 to 100 s by two sensors, from 5000 s and from 9000 s; the pass at
// 2000 s is no visit. The gaps are 4900 and 3900 s.
TEST(SurveySummary, RevisitsAreBetweenVisitsOfAnySensor) {
  const SensorSurvey a{
      .sensor = "a",
      .passes = {pass(0, 0, 60, 0.9), pass(0, 2000, 2100, 0.1), pass(0, 5000, 5100, 0.9)}};
  const SensorSurvey b{.sensor = "b", .passes = {pass(0, 40, 100, 0.9), pass(0, 9000, 9100, 0.7)}};
  const SurveySummary s = summarise_survey({a, b}, two_shells(), {30, 30}, 1);
  EXPECT_EQ(s.run.all.visits, 3u);
  EXPECT_EQ(s.run.all.revisits.count, 2u);
  EXPECT_NEAR(s.run.all.revisits.median_s, 3900.0, 1e-6);
  EXPECT_NEAR(s.run.all.revisits.most_of_90_s, 4900.0, 1e-6);
  EXPECT_EQ(s.run.shells[1].revisits.count, 0u);
}

TEST(SurveySummary, NightsAreDaysOfTheRun) {
  const SensorSurvey a{.sensor = "a",
                       .passes = {pass(1, 100, 200, 0.5), pass(1, 86400 + 100, 86400 + 200, 0.5)}};
  const SurveySummary s = summarise_survey({a}, two_shells(), {30}, 2);
  ASSERT_EQ(s.nights.size(), 2u);
  for (const auto& night : s.nights) EXPECT_NEAR(night.all.detected, 0.5, 1e-12);
  EXPECT_NEAR(s.run.all.detected, 0.75, 1e-12);
  EXPECT_EQ(s.run.all.revisits.count, 1u);
  EXPECT_EQ(s.nights[0].all.revisits.count, 0u);
  EXPECT_EQ(nights_of(sim_seconds(86400)), 1);
  EXPECT_EQ(nights_of(sim_seconds(86401)), 2);
  EXPECT_EQ(nights_of(sim_seconds(1)), 1);
}

TEST(SurveySummary, SensorsOfOnePlaceAreOneCandidate) {
  const auto at = [](const char* name, double longitude_deg) {
    return SensorConfig{.name = name, .place = SiteConfig{name, 30.0, longitude_deg, 100.0}};
  };
  SensorConfig in_orbit{.name = "orbit", .place = PlatformConfig{"1"}};
  const std::vector<SensorConfig> sensors{at("a", 10), in_orbit, at("b", 20), at("c", 10)};
  const auto sites = candidate_sites(sensors);
  ASSERT_EQ(sites.size(), 2u);
  EXPECT_EQ(sites[0].name, "a");
  EXPECT_EQ(sites[0].sensors, (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(sites[1].sensors, std::vector<std::size_t>{2});
  std::vector<SensorSurvey> surveys(4);
  surveys[0].passes = {pass(0, 0, 1, 0.5)};
  surveys[3].passes = {pass(0, 0, 1, 0.5)};
  surveys[1].passes = {pass(2, 86500, 86501, 0.9)};
  const SiteMisses misses = misses_of(surveys, sites, 3, 2);
  EXPECT_NEAR(misses.at(0, 0), std::log(0.25), 1e-12);
  EXPECT_EQ(misses.at(1, 0), 0.0);
  EXPECT_NEAR(misses.always[3 + 2], std::log(0.1), 1e-12);
  EXPECT_NEAR(objects_detected(misses, {0}), (0.75 + 0.9) / 2, 1e-12);
}

TEST(SurveySummary, APlaceHasManyLongitudes) {
  const auto at = [](double latitude_deg, double longitude_deg) {
    return SensorConfig{.name = "x", .place = SiteConfig{"x", latitude_deg, longitude_deg, 0.0}};
  };
  const std::vector<SensorConfig> sensors{at(-17, 180), at(-17, -180), at(51, 0), at(51, 359.5),
                                          at(51, -0.5), at(90, 0),     at(90, 77)};
  const auto sites = candidate_sites(sensors);
  ASSERT_EQ(sites.size(), 4u);
  EXPECT_EQ(sites[0].sensors, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(sites[2].sensors, (std::vector<std::size_t>{3, 4}));
  EXPECT_EQ(sites[3].sensors, (std::vector<std::size_t>{5, 6}));
}

TEST(SurveySummary, ASensorAddedNeverDetectsLess) {
  const SensorSurvey a{.sensor = "a", .passes = {pass(0, 0, 60, 0.5), pass(1, 0, 60, 0.2)}};
  const SensorSurvey b{.sensor = "b", .passes = {pass(1, 30, 90, 0.3), pass(2, 0, 10, 1e-6)}};
  const auto one = summarise_survey({a}, two_shells(), {30}, 1).run.all;
  const auto both = summarise_survey({a, b}, two_shells(), {30, 30}, 1).run.all;
  EXPECT_GE(both.detected, one.detected);
  EXPECT_GE(both.covered, one.covered);
  EXPECT_GE(both.visits, one.visits);
}

}  // namespace
}  // namespace dmise
