#include "core/score/intervals.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "core/score/matched_filter.h"

// References: tests/reference/score_values.py (scipy).
namespace dmise {
namespace {

TEST(Intervals, WilsonsAgreeWithScipy) {
  const struct {
    std::size_t successes, trials;
    double low, high;
  } cases[] = {{0, 10, 0.0, 0.277533},
               {10, 10, 0.722467, 1.0},
               {8, 10, 0.490162, 0.943318},
               {81, 263, 0.255289, 0.366210}};
  for (const auto& c : cases) {
    const Interval i = wilson_interval(c.successes, c.trials);
    EXPECT_NEAR(i.low, c.low, 1e-6);
    EXPECT_NEAR(i.high, c.high, 1e-6);
  }
  EXPECT_EQ(wilson_interval(0, 0).low, 0.0);
  EXPECT_EQ(wilson_interval(0, 0).high, 1.0);
}

TEST(Intervals, NeesAgreesWithScipysChiSquare) {
  const struct {
    std::size_t count;
    double low, high;
  } cases[] = {{1, 0.025318, 3.688879},
               {4, 0.272466, 2.191818},
               {61, 0.764921, 1.266097},
               {500, 0.914257, 1.089531},
               {5000, 0.972472, 1.027907}};
  for (const auto& c : cases) {
    const Interval i = nees_interval(c.count);
    EXPECT_NEAR(i.low, c.low, 2e-6) << c.count;
    EXPECT_NEAR(i.high, c.high, 2e-6) << c.count;
  }
}

// 4,000 trials of a detector with a threshold of 6.4: the estimate's sigma is 0.03.
TEST(Intervals, ThresholdOfADetectorIsFound) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise;
  std::uniform_real_distribution<double> snr(3.0, 10.0);
  std::vector<DetectionTrial> trials;
  for (int k = 0; k < 4000; ++k) {
    const double s = snr(random);
    trials.push_back({s, s + noise(random) > 6.4});
  }
  ASSERT_TRUE(fitted_threshold(trials));
  EXPECT_NEAR(*fitted_threshold(trials), 6.4, 0.1);
}

TEST(Intervals, ThresholdOfAllOrNoneIsUnknown) {
  EXPECT_FALSE(fitted_threshold({}));
  EXPECT_FALSE(fitted_threshold(std::vector<DetectionTrial>{{6.0, true}, {8.0, true}}));
  EXPECT_FALSE(fitted_threshold(std::vector<DetectionTrial>{{6.0, false}}));
}

// By symmetry: found at 8 and missed at 4 puts it in the middle.
TEST(Intervals, ThresholdOfTwoTrialsIsBetweenThem) {
  EXPECT_NEAR(*fitted_threshold(std::vector<DetectionTrial>{{8.0, true}, {4.0, false}}), 6.0, 1e-6);
  EXPECT_NEAR(*fitted_threshold(std::vector<DetectionTrial>{{100.0, false}, {0.0, true}}), 50.0,
              1e-6);
}

}  // namespace
}  // namespace dmise
