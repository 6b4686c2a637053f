#include "sensors/survey/detection_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dmise {
namespace {

/// Among stars with trails as those in which detection was measured.
ExpectedTrail at(double snr, double length_px) {
  return {.snr = snr, .length_px = length_px, .star_px = 2.4};
}

ExpectedTrail point(double snr, double star_px) {
  return {.snr = snr, .star_px = star_px, .unlike_px = star_px};
}

TEST(DetectionModel, HalfAtHalfAndRisingWithSnr) {
  const DetectionModel model{.trailed = {{0.0, 20.0, 0.3}, {30.0, 8.0, 0.2}},
                             .round = {{0.0, 50.0, 0.3}},
                             .round_known = {{0.0, 10.0, 0.3}},
                             .share = 0.9,
                             .share_points = 0.9};  // among round stars 1
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
// that it has, 20 among trails, and among those of 6 px or more that of a trail of 14 px.
TEST(DetectionModel, DependsOnWhatStarsLookLike) {
  const DetectionModel model{.trailed = {{0.0, 20.0, 0.3}, {14.0, 9.0, 0.3}, {30.0, 8.0, 0.3}},
                             .round = {{0.0, 50.0, 0.3}},
                             .round_known = {{0.0, 10.0, 0.3}}};
  const auto half = [&](const ExpectedTrail& trail) { return detection_probability(model, trail); };
  EXPECT_NEAR(half({.snr = 50.0, .star_px = 0.1}), 0.5, 1e-12);
  EXPECT_NEAR(half({.snr = 10.0, .star_px = 0.1, .star_known = true}), 0.5, 1e-12);
  EXPECT_NEAR(half({.snr = 20.0, .star_px = 2.4}), 0.5, 1e-12);
  EXPECT_NEAR(half({.snr = std::sqrt(50.0 * 20.0), .star_px = 1.4}), 0.5, 1e-12);
  EXPECT_NEAR(half({.snr = std::sqrt(20.0 * 9.0), .star_px = 4.2}), 0.5, 1e-12);
  EXPECT_NEAR(half({.snr = 9.0, .length_px = 3.0, .star_px = 9.9}), 0.5, 1e-12);
  EXPECT_NEAR(half({.snr = 8.0, .length_px = 30.0, .star_px = 9.9}), 0.5, 1e-12);
}

// The half SNR of what has nearly a star's shape is 40, unless the star would be known.
TEST(DetectionModel, ByShapeOrByLengthTheLesserCounts) {
  const DetectionModel model{.trailed = {{0.0, 20.0, 0.3}},
                             .round = {{0.0, 20.0, 0.3}},
                             .round_known = {{0.0, 20.0, 0.3}},
                             .shape = {{2.0, 40.0, 0.3}, {4.0, 10.0, 0.3}}};
  EXPECT_NEAR(detection_probability(model, point(40.0, 2.0)), 0.5, 1e-12);
  EXPECT_NEAR(detection_probability(model, point(20.0, 5.0)), 0.5, 1e-12);
  ExpectedTrail known = point(20.0, 2.0);
  known.star_known = true;
  EXPECT_NEAR(detection_probability(model, known), 0.5, 1e-12);
}

TEST(DetectionModel, ShapesDifferBySecondMoments) {
  const auto differ_px = [](double length_px, double star_px, double unlike_px) {
    return shape_difference_px(
        {.length_px = length_px, .star_px = star_px, .unlike_px = unlike_px});
  };
  EXPECT_NEAR(differ_px(0.0, 3.0, 3.0), 3.0, 1e-12);
  EXPECT_NEAR(differ_px(3.0, 3.0, 0.0), 0.0, 1e-12);
  EXPECT_NEAR(differ_px(5.0, 4.0, 1.0), 0.0, 1e-12);   // taken for a star
  EXPECT_NEAR(differ_px(5.0, 3.0, 2.0), 3.5, 1e-12);   // 1.5 + 4 x 0.5
  EXPECT_NEAR(differ_px(10.0, 6.0, 4.0), 8.0, 1e-12);  // along one line
  EXPECT_NEAR(differ_px(4.0, 4.0, std::sqrt(32.0)), std::sqrt(std::sqrt(512.0)), 1e-12);  // across
}

// Points of SNR 14 to 16 in 190 rendered frames (docs/models/survey.md), with the mean length of
// the stars' trails.
TEST(DetectionModel, PointsAmongTrailingStarsAreFoundAsInFrames) {
  struct Measured {
    double star_px;
    int points;
    double found;
  };
  for (const auto& m :
       {Measured{1.15, 128, 0.0}, Measured{1.65, 131, 0.008}, Measured{2.01, 32, 0.188},
        Measured{2.50, 162, 0.420}, Measured{3.00, 129, 0.752}, Measured{3.50, 88, 0.852},
        Measured{4.00, 60, 0.833}, Measured{4.77, 92, 0.826}}) {
    const double p = detection_probability(measured_detection_model(), point(15.0, m.star_px));
    EXPECT_NEAR(p, m.found, 3.0 * std::sqrt((p * (1.0 - p) + 0.01) / m.points)) << m.star_px;
  }
}

TEST(DetectionModel, MeasuredProbabilityRisesWithSnr) {
  for (const double star_px : {0.0, 0.7, 1.2, 1.6, 2.0, 3.0, 5.0, 12.0})
    for (const double length_px : {0.0, 0.9, 1.5, 3.0, 8.0, 30.0}) {
      double before = 0.0;
      for (double snr = 1.0; snr < 300.0; snr *= 1.05) {
        const double p =
            detection_probability(measured_detection_model(),
                                  {snr, length_px, star_px, std::hypot(length_px, star_px), false});
        EXPECT_GE(p, before) << star_px << " " << length_px << " " << snr;
        before = p;
      }
    }
}

TEST(DetectionModel, MeasuredProbabilityHasNoStepInTheLengthOfStars) {
  constexpr double step_px = 1e-6;
  for (const double star_px : {0.4, 1.0, 1.5, 2.4, 4.0, 6.0})
    for (const double length_px : {0.0, 1.5, 5.0})
      for (const double snr : {8.0, 15.0, 40.0}) {
        const auto p = [&](double star) {
          return detection_probability(measured_detection_model(),
                                       {snr, length_px, star, std::hypot(length_px, star), false});
        };
        EXPECT_NEAR(p(star_px - step_px), p(star_px + step_px), 1e-4)
            << star_px << " " << length_px << " " << snr;
      }
}

TEST(DetectionModel, TheFitFindsWhatSamplesWereDrawnFrom) {
  const DetectionModel truth{.trailed = {{0.0, 25.0, 0.4}, {10.0, 12.0, 0.3}, {100.0, 9.0, 0.15}},
                             .round = {{0.0, 40.0, 0.4}, {10.0, 12.0, 0.3}},
                             .round_known = {{0.0, 12.0, 0.3}},
                             .shape = {{1.0, 50.0, 0.3}, {3.0, 16.0, 0.3}, {8.0, 3.0, 0.3}},
                             .share = 0.97,
                             .share_points = 0.9,
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
               .star_px = even(dice) < 0.5 ? 0.2 : 2.0 + 2.0 * even(dice),
               .star_known = even(dice) < 0.5};
    s.trail.unlike_px = std::hypot(s.trail.length_px, s.trail.star_px);
    s.found = even(dice) < detection_probability(truth, s.trail);
    samples.push_back(s);
  }
  const DetectionModel fit = fitted_detection_model(start, samples);
  // What differs by 8 px is found by its length: samples do not tell of the last node.
  const std::size_t last = truth.shape.size() - 1;
  for (std::size_t list = 0; list < truth.nodes().size(); ++list)
    for (std::size_t k = 0; k < truth.nodes()[list]->size(); ++k) {
      if (truth.nodes()[list] == &truth.shape && k == last) continue;
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
