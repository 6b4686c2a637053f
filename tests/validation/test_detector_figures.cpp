#include "bench/validation/detector_figures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dmise {
namespace {

TrueSource streak_at(const std::string& id, double x_px, double y_px) {
  return {.sensor = "streaks_sparse",
          .frame = "1",
          .id = id,
          .start = {x_px - 20, y_px},
          .middle = {x_px, y_px},
          .end = {x_px + 20, y_px},
          .light = PixelPosition{x_px, y_px},
          .signal_e = 1000.0,
          .magnitude = 10.0};
}

FoundSource detection_at(double x_px, double y_px, double end1_x_px, double end2_x_px) {
  FoundSource found{.sensor = "streaks_sparse", .frame = "1"};
  Detection& d = found.detection;
  d.kind = DetectionKind::streak;
  d.x_px = x_px, d.y_px = y_px;
  d.covariance_px2 = {0.09, 0.0, 0.16};
  d.end1_x_px = end1_x_px, d.end2_x_px = end2_x_px;
  d.end1_y_px = d.end2_y_px = y_px;
  d.signal_e = 1000.0 * std::pow(10.0, -0.04);
  d.magnitude = 10.1;
  return found;
}

/// One of two streaks is found, its ends 1 and 2 px too short; another detection is of neither.
DetectorFigures figures(double end1_x_px = 21.0) {
  ScoredDraws drawn;
  drawn.probability = {{{"1", "a"}, 0.9}, {{"1", "b"}, 0.5}};
  ScoreInput input;
  input.frames.push_back({.sensor = "streaks_sparse",
                          .frame = "1",
                          .columns = 200,
                          .rows = 200,
                          .noise_e = 10.0,
                          .sigma_px = 1.0,
                          .exposure_s = 1.0});
  input.truths = {streak_at("a", 40, 20), streak_at("b", 120, 100)};
  input.detections = {detection_at(40.3, 20.0, end1_x_px, 58.0),
                      detection_at(150.0, 180.0, 140.0, 160.0)};
  input.detections[1].detection.index = 1;
  drawn.score = score(input, {});
  return detector_figures(drawn).front();
}

TEST(DetectorFigures, ExpectWhatTheSurveyExpects) {
  const DetectorFigures f = figures();
  EXPECT_EQ(f.all.bin.truths, 2u);
  EXPECT_EQ(f.all.bin.found, 1u);
  EXPECT_DOUBLE_EQ(f.all.expected, 1.4);
  EXPECT_NEAR(f.deviation_sigma(), (1.0 - 1.4) / std::sqrt(0.9 * 0.1 + 0.5 * 0.5), 1e-12);
  EXPECT_DOUBLE_EQ(f.false_alarms_a_frame, 1.0);
}

TEST(DetectorFigures, HaveErrorsOverTheirSigmas) {
  const DetectorFigures f = figures();
  EXPECT_NEAR(f.all.along_sigma.rms(), 1.0, 1e-6);  // 0.3 px of 0.3
  EXPECT_NEAR(f.all.across_sigma.rms(), 0.0, 1e-6);
  EXPECT_NEAR(f.all.magnitude.mean(), 0.1, 1e-9);
}

// Ends of 1 and 2 px: the root of 5. Half of the satellites are found, half of the detections are
// of none.
TEST(DetectorFigures, AreScoredAsSimsitDoes) {
  const SimsitFigures s = figures().simsit;
  EXPECT_DOUBLE_EQ(s.completeness, 0.5);
  EXPECT_DOUBLE_EQ(s.false_positive_rate, 0.5);
  EXPECT_NEAR(s.xy_rmse_px, std::sqrt(5.0), 1e-6);
  EXPECT_NEAR(s.flux_rmse_mag, 0.1, 1e-9);
}

// An end that is 30 px off is beyond the 20 px that SImSiT allows, though the streak is found.
TEST(DetectorFigures, AreStricterOfEndsBySimsit) {
  const DetectorFigures f = figures(50.0);
  EXPECT_EQ(f.all.bin.found, 1u);
  EXPECT_DOUBLE_EQ(f.simsit.completeness, 0.0);
  EXPECT_DOUBLE_EQ(f.simsit.false_positive_rate, 1.0);
}

}  // namespace
}  // namespace dmise
