#include "core/score/association.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "core/score/trail.h"
#include "tests/score/sources.h"

namespace dmise {
namespace {

using test::found;
using test::source;

TEST(Association, DetectionOfATrailIsItsOwn) {
  const std::vector<TrueSource> truths{source("a", {100, 100}, {200, 100}),
                                       source("b", {400, 300}, {400, 300})};
  const std::vector<FoundSource> detections{found(0, {400.3, 300.2}, {400.3, 300.2}),
                                            found(1, {101, 100.2}, {199, 99.9}),
                                            found(2, {700, 700}, {700, 700})};
  const auto a = associate(truths, detections, 5.0);
  EXPECT_EQ(a.detection_of_truth[0], 1u);
  EXPECT_EQ(a.detection_of_truth[1], 0u);
  EXPECT_EQ(a.false_alarms, std::vector<std::size_t>{2});
}

TEST(Association, StreakInPiecesIsOneWithItsPieces) {
  const std::vector<TrueSource> truths{source("a", {100, 100}, {400, 100})};
  const std::vector<FoundSource> detections{found(0, {100, 100}, {150, 100}),
                                            found(1, {160, 100}, {330, 100}),
                                            found(2, {340, 100}, {400, 100})};
  const auto a = associate(truths, detections, 5.0);
  EXPECT_EQ(a.detection_of_truth[0], 1u);  // nearest to the middle
  EXPECT_EQ(a.pieces_of_truth[0], (std::vector<std::size_t>{0, 2}));
  EXPECT_TRUE(a.false_alarms.empty());
}

TEST(Association, StreakThatCrossesATrailIsFalse) {
  const std::vector<TrueSource> truths{source("a", {100, 100}, {400, 100})};
  const std::vector<FoundSource> detections{found(0, {250, 20}, {250, 180})};
  const auto a = associate(truths, detections, 5.0);
  EXPECT_FALSE(a.detection_of_truth[0]);
  EXPECT_EQ(a.false_alarms.size(), 1u);
}

TEST(Association, CrossingStreaksKeepTheirDetections) {
  const std::vector<TrueSource> truths{source("a", {100, 100}, {300, 300}),
                                       source("b", {100, 300}, {300, 100})};
  const std::vector<FoundSource> detections{found(0, {100, 300}, {300, 100}),
                                            found(1, {100, 100}, {300, 300})};
  const auto a = associate(truths, detections, 5.0);
  EXPECT_EQ(a.detection_of_truth[0], 1u);
  EXPECT_EQ(a.detection_of_truth[1], 0u);
}

TEST(Association, ParallelStreaksThreePixelsApartKeepTheirDetections) {
  const std::vector<TrueSource> truths{source("a", {100, 100}, {300, 100}),
                                       source("b", {100, 103}, {300, 103}),
                                       source("c", {100, 106}, {300, 106})};
  const std::vector<FoundSource> detections{found(0, {100, 106}, {300, 106}),
                                            found(1, {100, 100}, {300, 100}),
                                            found(2, {100, 103}, {300, 103})};
  const auto a = associate(truths, detections, 5.0);
  EXPECT_EQ(a.detection_of_truth[0], 1u);
  EXPECT_EQ(a.detection_of_truth[1], 2u);
  EXPECT_EQ(a.detection_of_truth[2], 0u);
}

// Four satellites on one path, each 20 px behind the last, their trails overlapping.
TEST(Association, TrainKeepsItsOrder) {
  std::vector<TrueSource> truths;
  std::vector<FoundSource> detections;
  for (int k = 0; k < 4; ++k) {
    truths.push_back(source(std::to_string(k), {100.0 + 20 * k, 50}, {200.0 + 20 * k, 50}));
    detections.push_back(
        found(std::uint32_t(k), {101.0 + 20 * (3 - k), 50}, {201.0 + 20 * (3 - k), 50}));
  }
  const auto a = associate(truths, detections, 5.0);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(a.detection_of_truth[k], 3 - k);
}

// A greedy choice takes the pair at a distance of 1 px and leaves the others without a partner.
TEST(Association, TakesTheMostPairs) {
  const std::vector<TrueSource> truths{source("a", {100, 100}, {100, 100}),
                                       source("b", {104, 100}, {104, 100})};
  const std::vector<FoundSource> detections{found(0, {103, 100}, {103, 100}),
                                            found(1, {108, 100}, {108, 100})};
  const auto a = associate(truths, detections, 5.0);
  EXPECT_EQ(a.detection_of_truth[0], 0u);
  EXPECT_EQ(a.detection_of_truth[1], 1u);
}

TEST(Association, CurvedTrailIsFollowed) {  // 40 px off its chord
  TrueSource arc = source("a", {100, 100}, {500, 100});
  arc.middle = {300, 140};
  arc.light = arc.middle;
  FoundSource seen = found(0, {100, 100}, {500, 100});
  seen.detection.y_px = 140;
  const auto a = associate(std::vector{arc}, std::vector{seen}, 5.0);
  EXPECT_EQ(a.detection_of_truth[0], 0u);
}

TEST(Association, TruthWithoutLightTakesNone) {
  TrueSource dark = source("a", {100, 100}, {200, 100});
  dark.light.reset();
  const auto a = associate(std::vector{dark}, std::vector{found(0, {100, 100}, {200, 100})}, 5.0);
  EXPECT_FALSE(a.detection_of_truth[0]);
  EXPECT_EQ(a.false_alarms.size(), 1u);
}

// Against all permutations, in 200 crowded scenes of points: as many pairs, and the least sum.
TEST(Association, IsTheBestOfAllAssignments) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0.0, 14.0);
  for (int scene = 0; scene < 200; ++scene) {
    std::vector<TrueSource> truths;
    std::vector<FoundSource> detections;
    for (std::uint32_t k = 0; k < 5; ++k) {
      const PixelPosition a{place(random), place(random)}, b{place(random), place(random)};
      truths.push_back(source(std::to_string(k), a, a));
      detections.push_back(found(k, b, b));
    }
    const auto cost = [&](std::size_t t, std::size_t d) {
      const auto& seen = detections[d].detection;
      return std::pow(
          std::hypot(seen.x_px - truths[t].light->x_px, seen.y_px - truths[t].light->y_px) / 5.0,
          2);
    };
    std::vector<std::size_t> order(5);
    std::iota(order.begin(), order.end(), 0u);
    std::size_t most = 0;
    double least = 0.0;
    do {
      std::size_t pairs = 0;
      double sum = 0.0;
      for (std::size_t t = 0; t < 5; ++t)
        if (cost(t, order[t]) <= 1.0) ++pairs, sum += cost(t, order[t]);
      if (pairs > most || (pairs == most && sum < least)) most = pairs, least = sum;
    } while (std::ranges::next_permutation(order).found);
    const auto a = associate(truths, detections, 5.0);
    std::size_t pairs = 0;
    double sum = 0.0;
    for (std::size_t t = 0; t < 5; ++t)
      if (a.detection_of_truth[t]) ++pairs, sum += cost(t, *a.detection_of_truth[t]);
    EXPECT_EQ(pairs, most);
    EXPECT_NEAR(sum, least, 1e-9);
  }
}

}  // namespace
}  // namespace dmise
