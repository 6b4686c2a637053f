#include "core/score/trail.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dmise {
namespace {

TEST(TrueTrail, StraightOneIsMeasuredAlongAndAcross) {
  const TrueTrail trail({10, 20}, {40, 60}, {70, 100});  // 100 px towards (0.6, 0.8)
  EXPECT_NEAR(trail.length_px(), 100.0, 1e-9);
  const PixelPosition place =
      PixelPosition{10, 20} + PixelPosition{0.6, 0.8} * 30.0 + PixelPosition{-0.8, 0.6} * 2.0;
  const auto nearest = trail.nearest(place);
  EXPECT_NEAR(nearest.u, 0.3, 1e-9);
  EXPECT_NEAR(nearest.along_px, 30.0, 1e-9);
  EXPECT_NEAR(nearest.across_px, 2.0, 1e-9);
  EXPECT_NEAR(nearest.distance_px, 2.0, 1e-9);
}

TEST(TrueTrail, GoesOnAlongItsTangents) {
  const TrueTrail trail({0, 0}, {50, 0}, {100, 0});
  const auto before = trail.nearest({-3, 4}), after = trail.nearest({106, -8});
  EXPECT_NEAR(before.along_px, -3.0, 1e-9);
  EXPECT_NEAR(before.across_px, 4.0, 1e-9);
  EXPECT_NEAR(before.distance_px, 5.0, 1e-9);  // from its end
  EXPECT_NEAR(after.along_px, 106.0, 1e-9);
  EXPECT_NEAR(after.distance_px, 10.0, 1e-9);
}

// y = (x - 100)^2 / 500 on 0..200: 250 (s sqrt(1 + s^2) + asinh s) with s = 0.4.
TEST(TrueTrail, ParabolaIsAsLongAsInClosedForm) {
  const TrueTrail trail({0, 20}, {100, 0}, {200, 20});
  EXPECT_NEAR(trail.length_px(), 100 * std::sqrt(1.16) + 250 * std::asinh(0.4), 5e-3);
  // The normal at x = 150, slope 0.2, of length 3 to the right of the motion (down).
  const double root = std::sqrt(1.04);
  const auto nearest = trail.nearest({150 - 3 * 0.2 / root, 5 + 3 / root});
  EXPECT_NEAR(nearest.u, 0.75, 1e-6);
  EXPECT_NEAR(nearest.across_px, 3.0, 1e-6);
}

TEST(TrueTrail, PointHasADistanceAndNoLength) {
  const TrueTrail trail({5, 5}, {5, 5}, {5, 5});
  EXPECT_EQ(trail.length_px(), 0.0);
  EXPECT_NEAR(trail.nearest({8, 9}).distance_px, 5.0, 1e-12);
  EXPECT_EQ(trail.nearest({8, 9}).along_px, 0.0);
}

TEST(TrueTrail, PartInsideTheFrameIsCutAtItsEdge) {
  EXPECT_NEAR(TrueTrail({-50.5, 10}, {-0.5, 10}, {49.5, 10}).length_inside_px(100, 50), 50.0, 0.1);
  EXPECT_NEAR(TrueTrail({10, 10}, {20, 10}, {30, 10}).length_inside_px(100, 50), 20.0, 1e-6);
  EXPECT_EQ(TrueTrail({10, 60}, {20, 60}, {30, 60}).length_inside_px(100, 50), 0.0);
}

}  // namespace
}  // namespace dmise
