#include "core/optics/lens_ghost.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/optics/image_optics.h"

namespace dmise {
namespace {

constexpr int columns = 301, rows = 200;

ExpectedElectronImage seen(const ExpectedElectronImage& light, double fraction, double radius_px,
                           int thread_count = 1) {
  LensGhost ghost;
  ghost.ghost_fraction = fraction;
  ghost.ghost_radius_px = radius_px;
  Threads threads(thread_count);
  ExpectedElectronImage image = light;
  ghost.apply(image, threads);
  return image;
}

// A point's ghost is an even disc about its place mirrored at the centre, ((columns - 1) / 2,
// (rows - 1) / 2), with its share of the light: share / (pi r^2) in a pixel.
TEST(LensGhost, OfAPointIsAnEvenDiscOnTheOtherSideOfTheCentre) {
  ExpectedElectronImage light(columns, rows);
  light.at(60, 150) = 1e6f;
  const ExpectedElectronImage image = seen(light, 1e-3, 20.0);
  double sum = 0, x = 0, y = 0;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      if (i == 60 && j == 150) continue;
      sum += image.at(i, j), x += i * double(image.at(i, j)), y += j * double(image.at(i, j));
      const double r = std::hypot(i - 240.0, j - 49.0);
      const double expected = r > 20.0 ? 0.0 : 1000.0 / (pi * 400.0);
      EXPECT_NEAR(image.at(i, j), expected, r > 20.0 ? 0.0 : 0.02) << i << " " << j;
    }
  EXPECT_NEAR(sum, 1000.0, 0.01);
  EXPECT_NEAR(x / sum, 240.0, 1e-4);
  EXPECT_NEAR(y / sum, 49.0, 1e-4);
  EXPECT_EQ(image.at(60, 150), 1e6f);
}

// Far from the rim the ghost of even light is even: its share of the light.
TEST(LensGhost, OfEvenLightIsItsShare) {
  const ExpectedElectronImage image =
      seen(ExpectedElectronImage(columns, rows, 5000.0f), 0.01, 7.5);
  EXPECT_NEAR(image.at(150, 100), 5050.0, 0.01);
  EXPECT_NEAR(image.at(10, 189), 5050.0, 0.01);
  EXPECT_LT(image.at(0, 0), 5030.0);  // what lies beyond the frame has no ghost in it
}

TEST(LensGhost, DoesNotDependOnThreads) {
  ExpectedElectronImage light(columns, rows, 3.0f);
  light.at(5, 190) = 1e5f;
  EXPECT_EQ(seen(light, 1e-4, 12.3).pixels, seen(light, 1e-4, 12.3, 3).pixels);
}

TEST(LensGhost, SwitchedOffOrWithoutAShareItDoesNothing) {
  ImageOptics optics;
  optics.ghost_fraction = 0.01;
  EffectSet off;
  off.set(LensGhost::facts, false);
  ExpectedElectronImage image(columns, rows, 100.0f);
  Threads one(1);
  EffectTimes times;
  apply_image_optics(acting_optics(optics, off), image, one, times);
  apply_image_optics({}, image, one, times);
  EXPECT_EQ(image.pixels, ExpectedElectronImage(columns, rows, 100.0f).pixels);
  EXPECT_TRUE(times.seconds.empty());
  apply_image_optics(acting_optics(optics, {}), image, one, times);
  EXPECT_NEAR(image.at(150, 100), 101.0, 1e-4);
  EXPECT_GT(times[LensGhost::facts], 0.0);
}

}  // namespace
}  // namespace dmise
