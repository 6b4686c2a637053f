#include "core/camera_calibration/detector/pixel_series.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dmise {
namespace {

TEST(PixelSeries, LeavesOutWhatAParticleLeftInOneFrame) {
  PixelSeries series(2);
  for (const float v : {1.0f, -1.0f, 0.5f, 500.0f, -0.5f}) {
    const std::vector<float> frame{v, v > 100 ? 0.0f : v};
    series.add(frame, 1.0);
  }
  EXPECT_TRUE(series.at(0).struck);
  EXPECT_NEAR(series.at(0).mean, 0.0, 1e-6);
  EXPECT_FALSE(series.at(1).struck);
}

TEST(PixelSeries, WeighsFramesByTheirNoise) {
  PixelSeries series(1);
  series.add(std::vector<float>{1.0f}, 1.0);
  series.add(std::vector<float>{4.0f}, 2.0);
  EXPECT_NEAR(series.at(0).mean, (1.0 + 4.0 / 4) / (1 + 0.25), 1e-6);
}

TEST(PixelSeries, APixelWithoutAValueHasNone) {
  PixelSeries series(1);
  series.add(std::vector<float>{1.0f}, 1.0);
  series.add(std::vector<float>{std::nanf("")}, 1.0);
  series.add(std::vector<float>{1.0f}, 1.0);
  EXPECT_TRUE(std::isnan(series.at(0).mean));
}

}  // namespace
}  // namespace dmise
