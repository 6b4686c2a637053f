#include "sensors/survey/detection_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dmise {
namespace {

/// Among stars with trails as those in which detection was measured.
ExpectedTrail at(double snr, double length_px) {
  return {.snr = snr, .length_px = length_px, .star_px = 2.0};
}

TEST(DetectionModel, HalfAtHalfAndRisingWithSnr) {
  const DetectionModel model{.trailed = {{0.0, 20.0, 0.3}, {30.0, 8.0, 0.2}},
                             .round = {{0.0, 50.0, 0.3}},
                             .round_known = {{0.0, 10.0, 0.3}},
                             .share = 0.9};  // of round stars 1
  EXPECT_NEAR(detection_probability(model, at(20.0, 0.0)), 0.45, 1e-12);
  EXPECT_NEAR(detection_probability(model, at(8.0, 30.0)), 0.45, 1e-12);
  EXPECT_NEAR(detection_probability(model, at(8.0, 1000.0)), 0.45, 1e-12);
  // Q of -1: a normal deviate is below 1 with probability 0.841345.
  EXPECT_NEAR(detection_probability(model, at(20.0 * std::exp(0.3), 0.0)), 0.9 * 0.841344746, 1e-8);
  double before = 0.0;
  for (double snr = 0.0; snr < 200.0; snr += 0.5) {
    const double p = detection_probability(model, at(snr, 10.0));
    EXPECT_GE(p, before);
    EXPECT_LT(p, 1.0);
    before = p;
  }
  EXPECT_EQ(detection_probability(model, at(0.0, 10.0)), 0.0);
}

// The half SNR of a short trail is 50 among round stars that the catalogue may lack, 10 among such
// that it has, 20 among trails; a point before stars that trail by 32.4 px is as unlike them as a
// trail of 30 px before those of 2.4 px.
TEST(DetectionModel, DependsOnWhatStarsLookLike) {
  const DetectionModel model{.trailed = {{0.0, 20.0, 0.3}, {30.0, 8.0, 0.3}},
                             .round = {{0.0, 50.0, 0.3}},
                             .round_known = {{0.0, 10.0, 0.3}}};
  const auto half = [&](const ExpectedTrail& trail) { return detection_probability(model, trail); };
  EXPECT_NEAR(half({.snr = 50.0, .star_px = 0.1}), 0.5, 1e-12);
  EXPECT_NEAR(half({.snr = 10.0, .star_px = 0.1, .star_known = true}), 0.5, 1e-12);
  EXPECT_NEAR(half({.snr = 20.0, .star_px = 1.5}), 0.5, 1e-12);
  EXPECT_NEAR(half({.snr = std::sqrt(50.0 * 20.0), .star_px = 0.7}), 0.5, 1e-12);
  EXPECT_NEAR(half({.snr = 8.0, .star_px = 32.4, .unlike_px = 32.4}), 0.5, 1e-12);
  EXPECT_NEAR(half({.snr = 20.0, .star_px = 2.4, .unlike_px = 2.4}), 0.5, 1e-12);
  // Four pixels longer for each of a longer star's trail; like a star it is no longer.
  EXPECT_NEAR(half({.snr = 8.0, .length_px = 3.0, .star_px = 9.9, .unlike_px = 7.0}), 0.5, 1e-12);
  EXPECT_NEAR(half({.snr = 20.0, .star_px = 9.9, .unlike_px = 1.0}), 0.5, 1e-12);
}

TEST(DetectionModel, TheFitFindsWhatSamplesWereDrawnFrom) {
  const DetectionModel truth{.trailed = {{0.0, 25.0, 0.4}, {10.0, 12.0, 0.3}, {100.0, 9.0, 0.15}},
                             .round = {{0.0, 40.0, 0.4}, {10.0, 12.0, 0.3}},
                             .round_known = {{0.0, 12.0, 0.3}},
                             .share = 0.97,
                             .share_round = 0.99};
  DetectionModel start = truth;
  for (auto* nodes : start.nodes())
    for (auto& node : *nodes) node = {node.px, 12.0, 0.25};
  std::mt19937 dice(1);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::vector<DetectionSample> samples;
  for (int k = 0; k < 8000; ++k) {
    DetectionSample s;
    s.trail = {.snr = std::exp(5.0 * even(dice)),
               .length_px = std::exp(6.0 * even(dice)) - 1,
               .star_px = even(dice) < 0.5 ? 0.2 : 2.0,
               .star_known = even(dice) < 0.5};
    s.found = even(dice) < detection_probability(truth, s.trail);
    samples.push_back(s);
  }
  const DetectionModel fit = fitted_detection_model(start, samples);
  for (std::size_t list = 0; list < truth.nodes().size(); ++list)
    for (std::size_t k = 0; k < truth.nodes()[list]->size(); ++k) {
      const auto &found = (*fit.nodes()[list])[k], &drawn = (*truth.nodes()[list])[k];
      EXPECT_NEAR(std::log(found.half_snr / drawn.half_snr), 0.0, 0.2) << list << " " << k;
      EXPECT_NEAR(std::log(found.spread / drawn.spread), 0.0, 0.5) << list << " " << k;
    }
  EXPECT_NEAR(fit.share, truth.share, 0.02);
  EXPECT_NEAR(fit.share_round, truth.share_round, 0.02);
}

TEST(DetectionModel, WithoutSamplesTheFitIsTheStart) {
  const DetectionModel& start = measured_detection_model();
  const DetectionModel fit = fitted_detection_model(start, {});
  for (std::size_t list = 0; list < start.nodes().size(); ++list)
    for (std::size_t k = 0; k < start.nodes()[list]->size(); ++k) {
      const auto &now = (*fit.nodes()[list])[k], &then = (*start.nodes()[list])[k];
      EXPECT_NEAR(now.half_snr / then.half_snr, 1.0, 0.01);
      EXPECT_NEAR(now.spread / then.spread, 1.0, 0.02);
    }
}

}  // namespace
}  // namespace dmise
