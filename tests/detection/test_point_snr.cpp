#include "core/detection/source/point_snr.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "tests/support/simulated_frame.h"
#include "tests/support/simulated_scene.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;
using simulated::SimulatedScene;

constexpr int columns = 203, rows = 150;
constexpr double sky_e = 1500.0;
constexpr double read_e = 9.3;  // as the header says

SimulatedFrame sky() {
  return {camera_header(columns, rows, 1663, 0.0, 10.0, false), columns, rows, sky_e, 4};
}

TEST(PointSnr, OfNoiseScattersByOne) {
  SimulatedFrame frame = sky();
  const SimulatedScene exposed(frame.header(), frame.expose());
  const PointSnrImage snr = point_snr(exposed.scene);
  double sum = 0.0, square = 0.0;
  int count = 0;
  for (int y = 5; y < rows - 5; ++y)
    for (int x = 5; x < columns - 5; ++x, ++count) {
      sum += double(snr.at(x, y));
      square += std::pow(double(snr.at(x, y)), 2);
    }
  EXPECT_NEAR(sum / count, 0.0, 0.1);  // the level, of which each pixel has the same error
  EXPECT_NEAR(std::sqrt(square / count), 1.0, 0.05);
}

// A Gaussian of sigma s in white noise n a pixel has an SNR of F / (n s sqrt(4 pi)).
TEST(PointSnr, OfAStarIsThatOfTheIdealFilter) {
  SimulatedFrame frame = sky();
  frame.add_point(100, 70, 20000);
  const SimulatedScene exposed(frame.header(), frame.expose());
  const double expected =
      20000 / (std::sqrt(sky_e + read_e * read_e) * exposed.scene.sigma_px * std::sqrt(4 * pi));
  EXPECT_NEAR(point_snr(exposed.scene).at(100, 70), expected, 0.04 * expected + 3);
}

TEST(PointSnr, TakesPixelsWithoutAValueForBackground) {
  SimulatedFrame frame = sky();
  const SimulatedScene even(frame.header(), frame.expose());
  CountImage counts = even.counts;
  PixelMask unusable(columns, rows);
  for (int y = 40; y < 50; ++y) {
    counts.at(100, y) = 65535;
    unusable.at(100, y) = 1;
  }
  const SimulatedScene hot(frame.header(), std::move(counts));
  Scene masked = hot.scene;
  masked.unusable = &unusable;
  EXPECT_GT(point_snr(hot.scene).at(100, 45), 100.0F);
  EXPECT_LT(std::abs(point_snr(masked).at(100, 45)), 5.0F);
}

}  // namespace
}  // namespace dmise
