#include "core/dataset/object_mask.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"

namespace dmise {
namespace {

ExpectedElectronImage image_of(int columns, std::vector<float> pixels) {
  ExpectedElectronImage image(columns, int(pixels.size()) / columns);
  image.pixels = std::move(pixels);
  return image;
}

TEST(ObjectMask, IsTheFewestPixelsThatHoldTheShare) {
  const ObjectMask mask = mask_of(image_of(3, {0, 50, 0.5f, 30, 0.4f, 18.6f, 0, 0.5f, 0}), 0.98);
  EXPECT_EQ(mask.pixels, (std::vector<std::uint32_t>{1, 3, 5}));
  EXPECT_NEAR(mask.covered_e, 98.6, 1e-5);
  EXPECT_NEAR(mask.all_e, 100.0, 1e-5);
  EXPECT_EQ(mask.left, 0);
  EXPECT_EQ(mask.top, 0);
  EXPECT_EQ(mask.right, 3);
  EXPECT_EQ(mask.bottom, 2);
}

// The radius that holds 99 % of a Gaussian is sqrt(-2 ln 0.01) = 3.035 sigma.
TEST(ObjectMask, OfAGaussianIsADiscOfThreeSigma) {
  constexpr int size = 101;
  constexpr double sigma_px = 8.0;
  ExpectedElectronImage light(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      light.at(x, y) = float(
          1e4 * std::exp(-(std::pow(x - 50, 2) + std::pow(y - 50, 2)) / (2 * sigma_px * sigma_px)));
  const ObjectMask mask = mask_of(light);
  const double radius_px = std::sqrt(-2 * std::log(0.01)) * sigma_px;
  EXPECT_NEAR(double(mask.pixels.size()), M_PI * radius_px * radius_px,
              0.02 * M_PI * radius_px * radius_px);
  EXPECT_GE(mask.covered_e, 0.99 * mask.all_e);
}

TEST(ObjectMask, WithoutLightIsEmpty) {
  EXPECT_TRUE(mask_of(ExpectedElectronImage(4, 3)).empty());
  EXPECT_EQ(coco_counts(mask_of(ExpectedElectronImage(4, 3))), "<");  // 12 off: 48 + 12
}

// Values: pycocotools 2.0, mask.encode(np.asfortranarray(m))["counts"].
TEST(ObjectMask, CountsAreThoseOfPycocotools) {
  const auto counts = [](int columns, std::vector<float> pixels) {
    return coco_counts(mask_of(image_of(columns, std::move(pixels)), 1.0));
  };
  EXPECT_EQ(counts(3, {1, 0, 0, 1, 1, 0, 0, 1, 1}), "02200O");
  EXPECT_EQ(counts(2, {1, 1, 1, 1}), "04");
  std::vector<float> two(1200);
  two[5 * 40 + 7] = two[6 * 40 + 7] = two[29 * 40 + 39] = 1;
  EXPECT_EQ(counts(40, two), "g62fn0O");
}

TEST(ObjectMask, SnrIsThatOfTheBestFilter) {
  ElectronImage noise(2, 1);
  noise.pixels = {3, 4};
  EXPECT_DOUBLE_EQ(optimal_snr(image_of(2, {9, 16}), noise), 5.0);
}

TEST(LabelPlane, TheBrighterHasAPixelOfBoth) {
  LabelPlane plane(3, 1);
  const auto faint = image_of(3, {2, 2, 0}), bright = image_of(3, {0, 5, 5});
  plane.add(1, mask_of(faint), faint);
  plane.add(2, mask_of(bright), bright);
  EXPECT_EQ(plane.image().pixels, (std::vector<std::uint16_t>{1, 2, 2}));
  EXPECT_THROW(plane.add(65536, mask_of(faint), faint), Error);
}

}  // namespace
}  // namespace dmise
