#include "core/detection/streaks/points_beside.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/detection/detect.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr int size = 128;
constexpr double sky_e = 100.0, fwhm_px = 3.5;
constexpr double bright_e = 20000.0, fainter_e = 12600.0;  // half a magnitude

/// A frame of a telescope that follows an object: stars, of which there are none, trail by 48 px.
SimulatedFrame empty_frame(unsigned seed) {
  FrameHeader header = camera_header(size, size, 1663.0, 0.0, 400.0, true);
  header.psf_fwhm_px = fwhm_px;
  return {header, size, size, sky_e, seed};
}

std::vector<Detection> detections_in(SimulatedFrame& frame) {
  Threads one;
  return detect(frame.expose(), frame.header(), nullptr, one).detections;
}

/// Squared error of a place by its covariance, 2 on average.
double square_error(const Detection& d, PixelPosition true_px) {
  const double x = d.x_px - true_px.x_px, y = d.y_px - true_px.y_px;
  const auto [xx, xy, yy] = d.covariance_px2;
  return (yy * x * x - 2 * xy * x * y + xx * y * y) / (xx * yy - xy * xy);
}

/// Squared errors of two points' places; empty if there are not two detections.
std::vector<double> errors_of_pair(double apart_px, unsigned seed) {
  SimulatedFrame frame = empty_frame(seed);
  const double angle = frame.uniform(0, 2 * pi);
  const PixelPosition a{frame.uniform(40, 88), frame.uniform(40, 88)};
  const PixelPosition b{a.x_px + apart_px * std::cos(angle), a.y_px + apart_px * std::sin(angle)};
  frame.add_point(a.x_px, a.y_px, bright_e);
  frame.add_point(b.x_px, b.y_px, fainter_e);
  auto found = detections_in(frame);
  if (found.size() != 2) return {};
  std::ranges::sort(found, std::greater(), &Detection::signal_e);
  for (const Detection& d : found) EXPECT_EQ(d.kind, DetectionKind::point);
  return {square_error(found[0], a), square_error(found[1], b)};
}

// Reference: the places that were drawn. From 0.7 FWHM, where they are one blob, until they are
// two.
TEST(PointsBeside, AreTwoWithTheirErrors) {
  for (const double apart_px : {2.5, 3.5, 5.0, 7.0, 9.0, 11.0, 13.0, 16.0, 20.0}) {
    double sum = 0.0, count = 0.0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const auto errors = errors_of_pair(apart_px, seed);
      EXPECT_EQ(errors.size(), 2u) << apart_px << " px, seed " << seed;
      for (const double error : errors) sum += error, ++count;
    }
    // The mean of 40 is known to 2 / sqrt(40).
    EXPECT_NEAR(sum / count, 2.0, 4 * 2 / std::sqrt(40.0)) << apart_px;
  }
}

TEST(PointsBeside, OnePointIsOne) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SimulatedFrame frame = empty_frame(seed);
    const double light_e = 500 * std::pow(200.0, frame.uniform(0, 1));
    frame.add_point(frame.uniform(20, 108), frame.uniform(20, 108), light_e);
    EXPECT_EQ(detections_in(frame).size(), 1u) << seed << ", " << light_e;
  }
}

TEST(PointsBeside, AnEvenStreakIsOne) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SimulatedFrame frame = empty_frame(seed);
    frame.add_streak(64.3, 63.8, frame.uniform(2, 14), frame.uniform(0, pi), bright_e);
    EXPECT_EQ(detections_in(frame).size(), 1u) << seed;
  }
}

}  // namespace
}  // namespace dmise
