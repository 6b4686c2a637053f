#include <gtest/gtest.h>

#include "core/base/units.h"
#include "core/optics/projection.h"
#include "tests/projection/every_pixel.h"

namespace dmise {
namespace {

// A fisheye of 190 deg as calibrations give it, one whose image grows towards the rim, and a weak
// one.
const std::vector<std::array<double, 4>> lenses{
    {-0.013, 0.021, -0.0125, 0.0019}, {0.035, 0.004, 0.0007, 0.0001}, {1e-6, 0, 0, 0}};

// Reference: OpenCV's fisheye model, which knows the half space before the camera.
TEST(KannalaBrandt, FallsWhereOpenCvPutsIt) {
  for (const auto& k : lenses)
    test::expect_as_opencv(Projection(KannalaBrandt(k)), "fisheye", {k.begin(), k.end()},
                           89.9 * deg);
}

// Reference: the polynomial, beyond 90 deg.
TEST(KannalaBrandt, IsItsPolynomialBehindTheCamera) {
  for (const auto& k : lenses)
    for (const double t : {91 * deg, 105 * deg, 110 * deg}) {
      const auto place = Projection(KannalaBrandt(k)).image_of(0.6 * sin(t), 0.8 * sin(t), cos(t));
      ASSERT_TRUE(place);
      const double r =
          t + k[0] * pow(t, 3) + k[1] * pow(t, 5) + k[2] * pow(t, 7) + k[3] * pow(t, 9);
      EXPECT_NEAR((*place)[0], 0.6 * r, 1e-9 * r);
      EXPECT_NEAR((*place)[1], 0.8 * r, 1e-9 * r);
    }
}

TEST(KannalaBrandt, WithoutCoefficientsIsEquidistant) {
  const Projection none(KannalaBrandt({}));
  EXPECT_FALSE(none.fold_rad());
  for (double theta = 0.01; theta < pi; theta += 0.1)
    EXPECT_NEAR(none.height(theta), Projection::equidistant.height(theta), 1e-15);
}

TEST(KannalaBrandt, IsOneToOneAtEveryPixel) {
  for (const auto& k : lenses) {
    test::expect_one_to_one_at_every_pixel(
        test::camera_of(Projection(KannalaBrandt(k)), 2, 300, 200));
    test::expect_one_to_one_at_every_pixel(
        test::camera_of(Projection(KannalaBrandt(k)), 120, 301, 300));
    test::expect_one_to_one_at_every_pixel(
        test::camera_of(Projection(KannalaBrandt(k)), 190, 400, 100));
  }
}

// By hand: r = theta - k theta^3 turns back at theta = 1 / sqrt(3 k), 66.16 deg for k = 0.25, where
// r is 0.7698.
TEST(KannalaBrandt, NothingIsImagedBeyondTheAngleWhereTheImageTurnsBack) {
  const Projection lens(KannalaBrandt({-0.25, 0, 0, 0}));
  ASSERT_TRUE(lens.fold_rad());
  EXPECT_NEAR(*lens.fold_rad(), 2 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(lens.rim(), 4 / std::sqrt(27.0), 1e-12);
  EXPECT_TRUE(lens.image_of(std::sin(1.15), 0, std::cos(1.15)));
  EXPECT_FALSE(lens.image_of(std::sin(1.16), 0, std::cos(1.16)));
  EXPECT_TRUE(lens.direction_of(0.7697, 0));
  EXPECT_FALSE(lens.direction_of(0.7699, 0));
  EXPECT_FALSE(fold_in_frame_rad(test::camera_of(lens, 80, 400, 300)));
  EXPECT_TRUE(fold_in_frame_rad(test::camera_of(lens, 130, 400, 300)));  // in the corners
}

}  // namespace
}  // namespace dmise
