#include "sensors/survey/detection_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dmise {
namespace {

TEST(DetectionModel, HalfAtHalfAndRisingWithSnr) {
  const DetectionModel model{.lengths = {{0.0, 20.0, 0.3}, {30.0, 8.0, 0.2}}, .share = 0.9};
  EXPECT_NEAR(detection_probability(model, 20.0, 0.0), 0.45, 1e-12);
  EXPECT_NEAR(detection_probability(model, 8.0, 30.0), 0.45, 1e-12);
  EXPECT_NEAR(detection_probability(model, 8.0, 1000.0), 0.45, 1e-12);
  // Q of -1: a normal deviate is below 1 with probability 0.841345.
  EXPECT_NEAR(detection_probability(model, 20.0 * std::exp(0.3), 0.0), 0.9 * 0.841344746, 1e-8);
  double before = 0.0;
  for (double snr = 0.0; snr < 200.0; snr += 0.5) {
    const double p = detection_probability(model, snr, 10.0);
    EXPECT_GE(p, before);
    EXPECT_LT(p, 1.0);
    before = p;
  }
  EXPECT_EQ(detection_probability(model, 0.0, 10.0), 0.0);
}

TEST(DetectionModel, TheFitFindsWhatSamplesWereDrawnFrom) {
  const DetectionModel truth{.lengths = {{0.0, 25.0, 0.4}, {10.0, 12.0, 0.3}, {100.0, 9.0, 0.15}},
                             .share = 0.97};
  DetectionModel start = truth;
  for (auto& l : start.lengths) l = {l.length_px, 10.0, 0.25};
  std::mt19937 dice(1);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::vector<DetectionSample> samples;
  for (int k = 0; k < 20000; ++k) {
    DetectionSample s{.snr = std::exp(5.0 * even(dice)),
                      .length_px = std::exp(6.0 * even(dice)) - 1};
    s.found = even(dice) < detection_probability(truth, s.snr, s.length_px);
    samples.push_back(s);
  }
  const DetectionModel fit = fitted_detection_model(start, samples);
  for (std::size_t k = 0; k < truth.lengths.size(); ++k) {
    EXPECT_NEAR(std::log(fit.lengths[k].half_snr / truth.lengths[k].half_snr), 0.0, 0.06);
    EXPECT_NEAR(std::log(fit.lengths[k].spread / truth.lengths[k].spread), 0.0, 0.25);
  }
  EXPECT_NEAR(fit.share, truth.share, 0.01);
}

TEST(DetectionModel, WithoutSamplesTheFitIsTheStart) {
  const DetectionModel& start = measured_detection_model();
  const DetectionModel fit = fitted_detection_model(start, {});
  for (std::size_t k = 0; k < start.lengths.size(); ++k) {
    EXPECT_NEAR(fit.lengths[k].half_snr / start.lengths[k].half_snr, 1.0, 0.01);
    EXPECT_NEAR(fit.lengths[k].spread / start.lengths[k].spread, 1.0, 0.02);
  }
}

}  // namespace
}  // namespace dmise
