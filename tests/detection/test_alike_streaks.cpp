#include "core/detection/stars/alike_streaks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/detection/detect.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr int size = 768;
constexpr double sky_e = 1500.0;                                       // noise of 39.8 e- a pixel
constexpr double angle_rad = 0.7, trail_px = 109.0, trail_e = 9000.0;  // SNR of about 12

/// A streak as a fit leaves it, with errors of a pixel.
Source streak(double x_px, double y_px, double length_px, double angle, double sagitta_px = 0) {
  Source s;
  s.streak = true;
  s.free = trail_line | trail_sagitta;
  s.fit.trails = {{.x_px = x_px,
                   .y_px = y_px,
                   .flux_e = trail_e,
                   .length_px = length_px,
                   .angle_rad = angle,
                   .sagitta_px = sagitta_px}};
  s.fit.parameters = 6;
  s.fit.covariance.assign(36, 0.0);
  for (int i = 0; i < 6; ++i) s.fit.add_cov(i, i, i == 4 ? 1 / (length_px * length_px) : 1.0);
  return s;
}

/// As many streaks, with errors of their lengths and angles, at places all over a frame.
std::vector<Source> scattered(int count, double sagitta_px = 0) {
  std::vector<Source> out;
  for (int i = 0; i < count; ++i)
    out.push_back(streak(100 + 311 * i % 600, 100 + 173 * i % 571, trail_px + i % 3 - 1,
                         angle_rad + (i % 2 ? pi : 0.0) + 0.004 * (i % 3 - 1), sagitta_px));
  return out;
}

TEST(AlikeStreaks, AreFoundAmongOthers) {
  std::vector<Source> all = scattered(6);
  all.push_back(streak(300, 300, 60, 2.0));
  all.push_back(streak(200, 500, trail_px, angle_rad + 0.1));
  const auto alike = alike_streaks(all);
  ASSERT_TRUE(alike);
  EXPECT_EQ(alike->count, 6u);
  EXPECT_NEAR(std::hypot(alike->trail.x_px, alike->trail.y_px), trail_px, 1.0);
  EXPECT_NEAR(std::atan(alike->trail.y_px / alike->trail.x_px), angle_rad, 0.005);
}

TEST(AlikeStreaks, AreThreeOrMore) {
  EXPECT_TRUE(alike_streaks(scattered(3)));
  EXPECT_FALSE(alike_streaks(scattered(2)));
  EXPECT_FALSE(alike_streaks({}));
}

// Short trails have a tolerance as wide as a tenth of all streaks: only how closely they agree
// tells them from chance.
TEST(AlikeStreaks, AreKnownByHowCloselyTheyAgree) {
  std::vector<Source> all;
  for (int i = 0; i < 5; ++i)
    all.push_back(streak(100 + 311 * i % 600, 100 + 173 * i % 571, 15 + 0.2 * (i % 3 - 1),
                         angle_rad + 0.005 * (i % 3 - 1)));
  for (int i = 0; i < 5; ++i) all.push_back(streak(80 + 120 * i, 300, 25 + 40 * i, 0.3 + 0.6 * i));
  const auto alike = alike_streaks(all);
  ASSERT_TRUE(alike);
  EXPECT_EQ(alike->count, 5u);
  EXPECT_NEAR(std::hypot(alike->trail.x_px, alike->trail.y_px), 15.0, 0.3);
}

TEST(AlikeStreaks, AreNotThoseOfATrain) {
  std::vector<Source> train;
  for (int i = 0; i < 8; ++i)
    train.push_back(streak(100 + 70 * i, 150 + 50 * i + i % 2, trail_px, angle_rad));
  EXPECT_FALSE(alike_streaks(train));
}

TEST(AlikeStreaks, AreNotThoseOfChance) {
  SimulatedFrame random(camera_header(size, size, 5000, 0, 1, false), 1, 1, sky_e, 3);
  for (int frame = 0; frame < 100; ++frame) {
    std::vector<Source> all;
    for (int i = 0; i < 20; ++i)
      all.push_back(streak(random.uniform(0, size), random.uniform(0, size),
                           random.uniform(15, 150), random.uniform(0, pi)));
    EXPECT_FALSE(alike_streaks(all)) << frame;
  }
}

TEST(AlikeStreaks, BendToOneSide) {
  std::vector<Source> all;
  for (int i = 0; i < 6; ++i)  // alternately drawn from either end
    all.push_back(streak(100 + 311 * i % 600, 100 + 173 * i % 571, trail_px,
                         angle_rad + (i % 2 ? pi : 0.0), i % 2 ? -20 : 20));
  EXPECT_TRUE(alike_streaks(all));
  for (Source& s : all) s.fit.trails[0].sagitta_px = 20;
  const auto alike = alike_streaks(all);
  EXPECT_LE(alike ? alike->count : 0u, 3u);
}

/// A frame of a camera whose mount is not known and which says that it follows the stars.
SimulatedFrame empty_frame(unsigned seed) {
  FrameHeader header = camera_header(size, size, 5000, 0, 5, false);
  header.mount = "unknown";
  return {header, size, size, sky_e, seed};
}

DetectionResult detected(SimulatedFrame& frame) {
  Threads one;
  return detect(frame.expose(), frame.header(), nullptr, one);
}

TEST(AlikeStreaks, OfFewFaintStarsAreNoObjects) {
  for (const unsigned seed : {5U, 6U, 7U}) {
    SimulatedFrame frame = empty_frame(seed);
    for (int i = 0; i < 12; ++i)
      frame.add_streak(frame.uniform(0, size), frame.uniform(0, size), trail_px, angle_rad,
                       trail_e * std::pow(3, frame.uniform(0, 1)));
    for (int i = 0; i < 3; ++i) frame.add_point(150 + 200 * i, 620 - 110 * i, 3000);
    frame.add_streak(400, 200, 80, angle_rad + 1.2, 16000);
    const DetectionResult result = detected(frame);
    EXPECT_TRUE(result.star_trails) << seed;
    EXPECT_EQ(result.detections.size(), 4u) << seed;
  }
}

// Streaks that are alike and as many points: chance makes the former alike in one of 1000 frames.
TEST(AlikeStreaks, BesideAsManyPointsAreStars) {
  for (const unsigned seed : {15U, 16U, 17U}) {
    SimulatedFrame frame = empty_frame(seed);
    for (int i = 0; i < 4; ++i)
      frame.add_streak(150 + 311 * i % 500, 150 + 173 * i % 471, trail_px, angle_rad, 3 * trail_e);
    for (int i = 0; i < 4; ++i) frame.add_point(120 + 130 * i, 620 - 110 * i, 6000);
    const DetectionResult result = detected(frame);
    EXPECT_TRUE(result.star_trails) << seed;
    EXPECT_EQ(result.detections.size(), 4u) << seed;
  }
}

TEST(AlikeStreaks, OfATrainStayObjects) {
  SimulatedFrame frame = empty_frame(8);
  for (int i = 0; i < 5; ++i)
    frame.add_streak(100 + 138 * i, 120 + 116 * i, trail_px, angle_rad, 3 * trail_e);
  const DetectionResult result = detected(frame);
  EXPECT_FALSE(result.star_trails);
  EXPECT_EQ(result.detections.size(), 5u);
}

TEST(AlikeStreaks, AmongMoreStarsThatRestStayObjects) {
  SimulatedFrame frame = empty_frame(9);
  for (int i = 0; i < 25; ++i)
    frame.add_point(frame.uniform(0, size), frame.uniform(0, size), 4000);
  for (int i = 0; i < 4; ++i)
    frame.add_streak(150 + 311 * i % 500, 150 + 173 * i % 471, 60, angle_rad, 3 * trail_e);
  const DetectionResult result = detected(frame);
  EXPECT_FALSE(result.star_trails);
  EXPECT_EQ(result.detections.size(), 4u);
}

}  // namespace
}  // namespace dmise
