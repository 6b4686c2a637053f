#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/detection/detect.h"
#include "tests/support/simulated_frame.h"

// Streaks of which no pixel stands out of the noise.
namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr double sky_e = 1500.0;

/// Flux of a streak whose ideal matched filter has `snr`: the sum of squares of a blurred line.
double flux_of_snr(const FrameHeader& h, double length, double snr) {
  const double variance_e2 =
      sky_e + h.read_noise_e * h.read_noise_e + h.gain_e_per_dn * h.gain_e_per_dn / 12;
  const double psf = h.psf_fwhm_px / std::sqrt(8 * std::log(2.0));
  const double s = std::sqrt(psf * psf + 1.0 / 12), q = length / (2 * s);
  const double squares = (std::erf(q) - (1 - std::exp(-q * q)) / (q * std::sqrt(pi))) /
                         (2 * s * std::sqrt(pi) * length);
  return snr * std::sqrt(variance_e2 / squares);
}

struct Found {
  int found = 0, placed = 0, false_alarms = 0;
  double min_snr = 1e9;  // that is published
};

/// Streaks on a grid of a frame, and what the detector makes of them.
Found found_of(double length, double snr, int frames, int stars, double sagitta = 0.0) {
  constexpr int size = 1200;
  const int side = length > 250 ? 2 : 3;
  Found out;
  Threads threads(2);
  for (int f = 0; f < frames; ++f) {
    const auto header = camera_header(size, size, 1663, 0.6, stars ? 20 : 1e-3, true);
    SimulatedFrame frame(header, size, size, sky_e, 77u + unsigned(f));
    frame.add_stars(stars, 300, 2e5);
    std::vector<std::array<double, 3>> streaks;
    for (int i = 0; snr > 0 && i < side * side; ++i) {
      const double cell = double(size) / side, x = (i % side + 0.5) * cell;
      const double y = (i / side + 0.5) * cell, angle = frame.uniform(0, pi);
      frame.add_streak(x, y, length, angle, flux_of_snr(header, length, snr), 0, sagitta);
      streaks.push_back({x, y, angle});
    }
    const auto result = detect(frame.expose(), header, {}, threads);
    for (const Detection& d : result.detections) out.min_snr = std::min(out.min_snr, d.snr);
    std::vector<bool> used(result.detections.size());
    for (const auto& [x, y, angle] : streaks) {
      bool found = false;
      for (std::size_t k = 0; k < used.size(); ++k) {
        const double dx = result.detections[k].x_px - x, dy = result.detections[k].y_px - y;
        const double along = dx * std::cos(angle) + dy * std::sin(angle);
        const double across = dy * std::cos(angle) - dx * std::sin(angle);
        if (std::abs(along) > length / 2 || std::abs(across) > 3 + 0.03 * length) continue;
        found = used[k] = true;
      }
      out.found += found;
      ++out.placed;
    }
    for (const bool one : used) out.false_alarms += !one;
  }
  return out;
}

TEST(FaintStreaks, NoiseHasNone) { EXPECT_EQ(found_of(0, 0, 6, 0).false_alarms, 0); }

// 61 Mpx have lines of thousands of pixels, of which noise makes some that look like streaks.
TEST(FaintStreaks, NoiseOfTheLargestCamerasHasNone) {
  constexpr int columns = 9576, rows = 6388;
  const auto header = camera_header(columns, rows, 5000, 0.6, 1e-3, true);
  SimulatedFrame frame(header, columns, rows, sky_e, 5);
  Threads threads(2);
  EXPECT_EQ(detect(frame.expose(), header, {}, threads).detections.size(), 0u);
}

/// Pd = Q(threshold - SNR) with the threshold of 7.2 that noise demands, 0.5 in SNR later. With a
/// length of 300 px the SNR of a pixel is below 1.
TEST(FaintStreaks, AreFoundAtAnSnrThatTheirPixelsDoNotShow) {
  for (const double length : {100.0, 300.0}) {
    const Found found = found_of(length, 9.5, 4, 0);
    EXPECT_GT(found.found, 0.85 * found.placed) << length;  // Q(7.7 - 9.5) = 0.96
    EXPECT_EQ(found.false_alarms, 0) << length;
  }
}

// Light that its own error does not exclude is no detection, however well a line fits it.
TEST(FaintStreaks, AreNotPublishedBelowTheThreshold) {
  for (const double length : {30.0, 100.0, 300.0})
    for (const double snr : {7.5, 8.5}) {
      const Found found = found_of(length, snr, 3, 0);
      EXPECT_GE(found.min_snr, 4.0) << length << ", " << snr;
      EXPECT_GT(found.found, 0) << length << ", " << snr;
    }
}

TEST(FaintStreaks, AreFoundAmongStars) {
  const Found found = found_of(150, 12.0, 3, 1500);  // one star for every 1000 px
  EXPECT_GE(found.found, found.placed - 2);
  EXPECT_LE(found.false_alarms, 1);
}

TEST(FaintStreaks, MayBeBent) {
  const Found found = found_of(200, 14.0, 3, 0, 3.0);
  EXPECT_GE(found.found, found.placed - 1);
}

TEST(FaintStreaks, MayLeaveTheFrame) {
  const auto header = camera_header(900, 700, 1663, 0.6, 1e-3, true);
  int found = 0;
  Threads threads;
  for (int seed = 0; seed < 5; ++seed) {
    SimulatedFrame frame(header, 900, 700, sky_e, 300u + unsigned(seed));
    // Two thirds of it are inside.
    frame.add_streak(880, 350 + 40 * seed, 240, 2.8, flux_of_snr(header, 240, 18));
    const auto result = detect(frame.expose(), header, {}, threads);
    for (const Detection& d : result.detections) found += d.at_edge;
  }
  EXPECT_GE(found, 4);
}

/// The covariance of the centroid, whose part along the track is that of two ends in noise.
TEST(FaintStreaks, KnowHowBadlyTheirEndsAreKnown) {
  const auto header = camera_header(1200, 1200, 1663, 0.6, 1e-3, true);
  Threads threads(2);
  std::vector<double> nees;
  for (int f = 0; f < 5; ++f) {
    SimulatedFrame frame(header, 1200, 1200, sky_e, 900u + unsigned(f));
    std::vector<PixelPosition> places;
    for (int i = 0; i < 9; ++i) {
      places.push_back({200.0 + 400 * (i % 3), 200.0 + 400 * (i / 3)});
      frame.add_streak(places.back().x_px, places.back().y_px, 150, frame.uniform(0, pi),
                       flux_of_snr(header, 150, 12));
    }
    for (const Detection& d : detect(frame.expose(), header, {}, threads).detections)
      for (const PixelPosition& place : places) {
        const double dx = d.x_px - place.x_px, dy = d.y_px - place.y_px;
        if (std::hypot(dx, dy) > 80) continue;
        const auto [xx, xy, yy] = d.covariance_px2;
        nees.push_back((dx * dx * yy - 2 * dx * dy * xy + dy * dy * xx) / (xx * yy - xy * xy) / 2);
      }
  }
  ASSERT_GT(nees.size(), 35u);
  std::sort(nees.begin(), nees.end());
  // The median of chi-square of two degrees over two is 0.69.
  EXPECT_NEAR(nees[nees.size() / 2], 0.69, 0.45);
}

/// A few of 400 streaks of 60 px have lost an end to noise: their covariances say so. The mean of
/// as many is 1 +- 0.07, as those few have larger squares than a normal distribution.
TEST(FaintStreaks, KnowThatAnEndMayBeLost) {
  constexpr int side = 10;
  const auto header = camera_header(1200, 1200, 1663, 0.6, 1e-3, true);
  Threads threads(2);
  double sum = 0.0;
  int found = 0;
  for (unsigned f = 0; f < 4; ++f) {
    SimulatedFrame frame(header, 1200, 1200, sky_e, 950u + f);
    std::vector<PixelPosition> places;
    for (int i = 0; i < side * side; ++i) {
      places.push_back({105.0 + 110 * (i % side), 105.0 + 110 * (i / side)});
      frame.add_streak(places.back().x_px, places.back().y_px, 60, frame.uniform(0, pi),
                       flux_of_snr(header, 60, 12));
    }
    for (const Detection& d : detect(frame.expose(), header, {}, threads).detections)
      for (const PixelPosition& place : places) {
        const double dx = d.x_px - place.x_px, dy = d.y_px - place.y_px;
        if (std::hypot(dx, dy) > 35) continue;
        const auto [xx, xy, yy] = d.covariance_px2;
        sum += (dx * dx * yy - 2 * dx * dy * xy + dy * dy * xx) / (xx * yy - xy * xy) / 2;
        ++found;
      }
  }
  ASSERT_GT(found, 370);
  EXPECT_NEAR(sum / found, 1.0, 0.2);
}

}  // namespace
}  // namespace dmise
