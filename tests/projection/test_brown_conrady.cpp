#include <gtest/gtest.h>

#include "core/base/units.h"
#include "core/optics/projection.h"
#include "tests/projection/every_pixel.h"

namespace dmise {
namespace {

// k1 k2 k3 p1 p2: barrel with tangential terms, pincushion, moustache, tangential alone.
const std::vector<std::array<double, 5>> lenses{{-0.3728, 0.2037, -0.0723, 0.00219, 0.00138},
                                                {0.08, 0.01, 0, -1e-4, 2e-4},
                                                {-0.12, 0.09, 0.02, 0, 0},
                                                {0, 0, 0, 0.01, -0.02}};

// Reference: OpenCV's pinhole model.
TEST(BrownConrady, FallsWhereOpenCvPutsIt) {
  for (const auto& [k1, k2, k3, p1, p2] : lenses)
    test::expect_as_opencv(Projection(BrownConrady({k1, k2, k3, p1, p2})), "pinhole",
                           {k1, k2, p1, p2, k3}, 45 * deg);
}

TEST(BrownConrady, WithoutCoefficientsIsGnomonic) {
  const Projection none(BrownConrady({}));
  EXPECT_FALSE(none.fold_rad());
  const auto plain = Projection::gnomonic.image_of(0.36, 0.48, 0.8),
             place = none.image_of(0.36, 0.48, 0.8);
  ASSERT_TRUE(place);
  EXPECT_NEAR((*place)[0], (*plain)[0], 1e-15);
  EXPECT_NEAR((*place)[1], (*plain)[1], 1e-15);
  EXPECT_FALSE(none.image_of(0, 1, 0));
}

TEST(BrownConrady, IsOneToOneAtEveryPixel) {
  for (const auto& values : lenses) {
    const Projection lens{BrownConrady(values)};
    test::expect_one_to_one_at_every_pixel(test::camera_of(lens, 1, 300, 200));
    test::expect_one_to_one_at_every_pixel(test::camera_of(lens, 60, 300, 301));
    test::expect_one_to_one_at_every_pixel(test::camera_of(lens, 80, 400, 100));
  }
}

// By hand: r - k r^3 turns back at r = 1 / sqrt(3 k), 49.11 deg for k = 0.25; 2 p1 x y and
// p2 (r^2 + 2 x^2) along x at 1 + 6 p2 x = 0.
TEST(BrownConrady, NothingIsImagedBeyondWhereTheImageTurnsBack) {
  const Projection lens(BrownConrady({-0.25, 0, 0, 0, 0}));
  ASSERT_TRUE(lens.fold_rad());
  EXPECT_NEAR(std::tan(*lens.fold_rad()), 2 / std::sqrt(3.0), 1e-12);
  EXPECT_FALSE(lens.image_of(1.16, 0, 1));
  EXPECT_TRUE(lens.image_of(1.15, 0, 1));
  EXPECT_TRUE(lens.direction_of(0.7697, 0));
  EXPECT_FALSE(lens.direction_of(0.7699, 0));
  EXPECT_FALSE(lens.direction_of(30, 40));
  EXPECT_TRUE(fold_in_frame_rad(test::camera_of(lens, 90, 400, 400)));  // in the corners
  EXPECT_FALSE(fold_in_frame_rad(test::camera_of(lens, 60, 400, 400)));
  EXPECT_NEAR(std::tan(*Projection(BrownConrady({0, 0, 0, 0, 0.1})).fold_rad()), 1 / 0.6, 1e-12);
}

}  // namespace
}  // namespace dmise
