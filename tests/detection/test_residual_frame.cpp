#include "core/detection/source/residual_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/detection/source/source_fit.h"
#include "tests/support/simulated_frame.h"
#include "tests/support/simulated_scene.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;
using simulated::SimulatedScene;

constexpr int columns = 200, rows = 160;
constexpr double sky_e = 1500.0;  // noise of 39.8 e- a pixel
constexpr Trail star{
    .x_px = 90.3, .y_px = 70.8, .flux_e = 200000.0, .length_px = 30.0, .angle_rad = 0.7};

SimulatedFrame sky() {
  return {camera_header(columns, rows, 1663, 0.0, 10.0, false), columns, rows, sky_e, 9};
}

/// One noise for both, with the light of stars that were drawn or without.
SimulatedScene exposed(bool with_star) {
  SimulatedFrame noise = sky(), light = sky();
  CountImage counts = noise.expose();
  light.add_streak(star.x_px, star.y_px, star.length_px, star.angle_rad, star.flux_e);
  const double gain = light.header().gain_e_per_dn;
  if (with_star)
    for (std::size_t i = 0; i < counts.pixels.size(); ++i)
      counts.pixels[i] +=
          std::uint16_t(std::lround((double(light.electrons().pixels[i]) - sky_e) / gain));
  return {light.header(), std::move(counts)};
}

double sum_of_light_e(const ResidualFrame& residual) {
  double sum = 0.0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) sum += double(residual.light_e(x, y));
  return sum;
}

TEST(ResidualFrame, HasAllLightOfAStarInsideTheFrame) {
  const SimulatedScene empty = exposed(false);
  ResidualFrame residual(empty.scene);
  EXPECT_EQ(sum_of_light_e(residual), 0.0);
  residual.subtract(star);
  EXPECT_NEAR(sum_of_light_e(residual), star.flux_e, 1e-3 * star.flux_e);
  Trail half = star;  // its middle is on the frame's edge
  half.x_px = -0.5;
  half.angle_rad = 0.0;
  ResidualFrame other(empty.scene);
  other.subtract(half);
  EXPECT_NEAR(sum_of_light_e(other), star.flux_e / 2, 1e-3 * star.flux_e);
  Trail beside = star;
  beside.x_px = -100.0;
  residual.subtract(beside);
  EXPECT_NEAR(sum_of_light_e(residual), star.flux_e, 1e-3 * star.flux_e);
}

// What is left of a frame is the frame of the same noise without the star.
TEST(ResidualFrame, IsTheFrameWithoutTheStar) {
  const SimulatedScene with = exposed(true), without = exposed(false);
  const PointSnrImage before = point_snr(with.scene), truth = point_snr(without.scene);
  ResidualFrame residual(with.scene, before);
  residual.subtract(star);
  double most_before = 0.0, most = 0.0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    most_before = std::max(most_before, std::abs(double(before.pixels[i] - truth.pixels[i])));
    most = std::max(most, std::abs(double(residual.snr().pixels[i] - truth.pixels[i])));
  }
  EXPECT_GT(most_before, 100.0);
  EXPECT_LT(most, 0.02 * most_before);
}

TEST(ResidualFrame, TakesStarsBack) {
  const SimulatedScene with = exposed(true);
  const PointSnrImage before = point_snr(with.scene);
  ResidualFrame residual(with.scene, before);
  residual.subtract(star);
  residual.restore(star);
  double most = 0.0;
  for (std::size_t i = 0; i < before.pixels.size(); ++i)
    most = std::max(most, std::abs(double(residual.snr().pixels[i] - before.pixels[i])));
  EXPECT_LT(most, 1e-3);
  EXPECT_NEAR(sum_of_light_e(residual), 0.0, 0.1);
}

TEST(ResidualFrame, PixelsHaveTheLightOfStarsAsNoise) {
  const SimulatedScene with = exposed(true);
  ResidualFrame residual(with.scene);
  const Trail across{.x_px = star.x_px, .y_px = star.y_px, .length_px = 20.0, .angle_rad = 2.3};
  const auto before = residual.pixels_around(across, 3.0);
  residual.subtract(star);
  const auto after = residual.pixels_around(across, 3.0);
  ASSERT_EQ(after.size(), before.size());
  ASSERT_GT(after.size(), 100u);
  for (std::size_t i = 0; i < after.size(); ++i) {
    ASSERT_EQ(after[i].x, before[i].x);
    ASSERT_EQ(after[i].y, before[i].y);
    const double e = double(residual.light_e(after[i].x, after[i].y));
    EXPECT_NEAR(after[i].signal_e, double(before[i].signal_e) - e, 1e-3 * (1 + e));
    // Photons of the light, and 5 % of it as the error of its shape.
    EXPECT_NEAR(after[i].variance_e2, double(before[i].variance_e2) + e + 0.0025 * e * e,
                1e-3 * (1 + e));
  }
}

}  // namespace
}  // namespace dmise
