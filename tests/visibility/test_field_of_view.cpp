#include "core/visibility/field_of_view.h"

#include <gtest/gtest.h>

#include "core/base/units.h"
#include "tests/visibility/watch.h"

namespace dmise {
namespace {

Vec<CameraFrame> towards(double x_deg, double y_deg) {
  return {std::tan(x_deg * deg), std::tan(y_deg * deg), 1.0};
}

TEST(FieldOfView, IsTheRectangleAndNotTheConeAroundIt) {
  const FieldOfView field(test::flat_camera(90, 60));
  EXPECT_TRUE(field.contains(towards(44.99, 0)));
  EXPECT_FALSE(field.contains(towards(45.02, 0)));
  EXPECT_TRUE(field.contains(towards(0, 29.98)));
  EXPECT_FALSE(field.contains(towards(0, 30.02)));  // 45 deg would be in the cone
  EXPECT_TRUE(field.contains(towards(44.9, 29.9)));
}

TEST(FieldOfView, HoldsNothingBehindTheCamera) {
  const FieldOfView field(test::flat_camera(90, 60));
  EXPECT_FALSE(field.contains({0, 0, -1}));
  EXPECT_FALSE(field.contains({1, 0, 0}));
  EXPECT_GT(field.outside_m({0, 0, -1000}), 0.0);
}

// 1000 m straight beside the edge of a 90 deg field at 1000 m of depth: (1000 - 0) sin 45 deg.
TEST(FieldOfView, DistanceToAnEdgeIsThatOfThePlaneThroughIt) {
  const FieldOfView field(test::flat_camera(90, 60));
  EXPECT_NEAR(field.outside_m({2000, 0, 1000}), 1000 * std::sqrt(0.5), 1e-6);
  EXPECT_LT(field.outside_m({0, 0, 1000}), 0.0);
}

// What makes skipping work safe: no step changes the distance by more than its own length, and a
// place in the field is at distance 0 at most.
TEST(FieldOfView, DistanceNeverChangesFasterThanThePlaceMoves) {
  for (const Optics& optics : {test::flat_camera(90, 60), test::all_sky_camera(), [] {
                                 Optics o = test::all_sky_camera();
                                 o.columns = o.rows = 900;
                                 return o;
                               }()}) {
    const FieldOfView field(optics);
    unsigned state = 1;
    const auto random = [&] {
      return double((state = state * 1664525u + 1013904223u) >> 8) / 8388608.0 - 1.0;
    };
    for (int k = 0; k < 20000; ++k) {
      const Vec<CameraFrame> a{random() * 1e7, random() * 1e7, random() * 1e7};
      const Vec<CameraFrame> step{random() * 1e6, random() * 1e6, random() * 1e6};
      const double change = field.outside_m(a + step) - field.outside_m(a);
      ASSERT_LE(std::abs(change), norm(step) * (1 + 1e-12) + 1e-6);
      const bool inside = field.contains(a);
      ASSERT_TRUE(!inside || field.outside_m(a) <= 1e-6);
    }
  }
}

}  // namespace
}  // namespace dmise
