#include "core/score/matched_filter.h"

#include <gtest/gtest.h>

// References: tests/reference/score_values.py, sums over pixels of the pixel-integrated trail.
namespace dmise {
namespace {

TEST(MatchedFilter, SnrIsThatOfTheSquaredTemplateOverPixels) {
  const struct {
    double sigma_px, length_px, snr;
  } cases[] = {{0.8, 0, 33.1337},
               {2.0, 0, 13.9596},
               {0.8, 5, 23.1396},
               {0.8, 100, 5.7285},
               {2.0, 20, 7.8639}};
  for (const auto& c : cases)
    EXPECT_NEAR(matched_filter_snr({1000.0, c.length_px, 10.0, c.sigma_px}) / c.snr, 1.0, 0.01)
        << c.sigma_px << " " << c.length_px;
}

TEST(MatchedFilter, PositionBoundIsThatOfTheFisherMatrixOverPixels) {
  const struct {
    double signal_e, length_px, bound_px;
  } cases[] = {{1e3, 0, 0.132610}, {1e6, 0, 0.001554}, {1e4, 50, 0.040723}, {1e7, 50, 0.000489}};
  for (const auto& c : cases)
    EXPECT_NEAR(position_bound_px({c.signal_e, c.length_px, 10.0, 1.5}) / c.bound_px, 1.0, 0.03)
        << c.signal_e << " " << c.length_px;
}

TEST(MatchedFilter, ShortTrailIsAPoint) {
  const double point = matched_filter_snr({1000.0, 0.0, 10.0, 1.5});
  EXPECT_NEAR(matched_filter_snr({1000.0, 1e-6, 10.0, 1.5}), point, 1e-9);
  EXPECT_NEAR(matched_filter_snr({1000.0, 0.01, 10.0, 1.5}), point, 1e-4 * point);
}

// Q of the normal distribution: 0.5 at the threshold, 0.8413 one sigma above, 2.866516e-7 five
// below.
TEST(MatchedFilter, TheoryIsTheNormalDistribution) {
  EXPECT_DOUBLE_EQ(theory_of_detection(6.0, 6.0), 0.5);
  EXPECT_NEAR(theory_of_detection(7.0, 6.0), 0.841344746, 1e-9);
  EXPECT_NEAR(theory_of_detection(1.0, 6.0), 2.866516e-7, 1e-13);
}

}  // namespace
}  // namespace dmise
