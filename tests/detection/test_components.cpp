#include "core/detection/pixels/components.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

constexpr double sky_e = 2000.0;

double filter_sigma_px(const FrameHeader& header) {
  const double sigma = header.psf_fwhm_px / std::sqrt(8 * std::log(2.0));
  return std::sqrt(sigma * sigma + 1.0 / 12);
}

// Matched-filter theory: flux F at a pixel's centre peaks at F sqrt(sum p^2) / noise, standard
// deviation 1.
TEST(Components, PeakSnrIsTheMatchedFilters) {
  auto header = simulated::camera_header(1200, 1200, 1663, 0, 20, false);
  simulated::SimulatedFrame frame(header, 1200, 1200, sky_e, 1);
  const double flux_e = 4000.0;
  for (int i = 0; i < 400; ++i) frame.add_point(40 + 58 * (i % 20), 40 + 58 * (i / 20), flux_e);
  Threads threads;
  const CountImage counts = frame.expose();
  const Background background(counts, 64, threads);
  const double sigma_px = filter_sigma_px(header);
  const auto found = find_components(counts, background, sigma_px, 3, 5, threads);
  double sum = 0.0;
  int n = 0;
  for (const Component& c : found)
    if ((c.peak_x - 40) % 58 == 0 && (c.peak_y - 40) % 58 == 0) {
      sum += c.peak_snr;
      ++n;
    }
  const double noise_e = std::sqrt(sky_e + header.read_noise_e * header.read_noise_e);
  const double theory = flux_e * std::sqrt(kernel_square_sum(sigma_px)) / noise_e;
  EXPECT_GT(n, 350);
  EXPECT_NEAR(sum / n, theory, 0.03 * theory);
}

// A normal variable exceeds 4 with probability 3.17e-5; neighbours in the filtered frame go
// together, so there are fewer pieces than pixels.
TEST(Components, NoiseAloneExceedsTheThresholdAsOftenAsNormalNoise) {
  const auto header = simulated::camera_header(2000, 2000, 1663, 0, 20, false);
  simulated::SimulatedFrame frame(header, 2000, 2000, sky_e, 2);
  Threads threads(2);
  const CountImage counts = frame.expose();
  const Background background(counts, 64, threads);
  int pixels = 0;
  for (const auto& c : find_components(counts, background, filter_sigma_px(header), 4, 4, threads))
    pixels += c.pixels;
  const double expected = 4e6 * 3.167e-5;
  EXPECT_NEAR(pixels, expected, 5 * std::sqrt(2 * expected));
}

TEST(Components, PiecesThatTouchAtACornerAreOne) {
  CountImage counts(64, 200, 100);
  for (int i = 0; i < 200; ++i) counts.at(i % 64, i) = std::uint16_t(101 - i % 2 * 2);
  for (int i = 10; i < 50; ++i) counts.at(i, 80 + i / 2) = 5000;  // across a band's border
  Threads threads;
  const Background background(counts, 64, threads);
  const auto found = find_components(counts, background, 0.3, 50, 100, threads);
  ASSERT_EQ(found.size(), 1u);
  // The filter's skirts add a pixel on each side.
  EXPECT_EQ(found[0].min_x, 9);
  EXPECT_EQ(found[0].max_x, 50);
  EXPECT_EQ(found[0].min_y, 84);
  EXPECT_EQ(found[0].max_y, 105);
}

}  // namespace
}  // namespace dmise
