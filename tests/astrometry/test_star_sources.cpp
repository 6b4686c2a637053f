#include "core/astrometry/star_sources.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

struct Truth {
  double x, y, flux_e;
};

StarSourceSettings settings_of(const FrameHeader& h) {
  return {.gain_e_per_dn = h.gain_e_per_dn,
          .saturation_dn = h.saturation_dn - 100,
          .psf_fwhm_px = h.psf_fwhm_px};
}

/// Stars on a loose grid, at random places within their cells.
std::vector<Truth> add_grid(simulated::SimulatedFrame& frame, int columns, int rows, double min_e,
                            double max_e, bool trails) {
  std::vector<Truth> stars;
  for (int y = 30; y < rows - 30; y += 40)
    for (int x = 30; x < columns - 30; x += 40) {
      const Truth t{x + frame.uniform(-5, 5), y + frame.uniform(-5, 5),
                    min_e * std::pow(max_e / min_e, frame.uniform(0, 1))};
      if (trails)
        frame.add_streak(t.x, t.y, 6, 0.6, t.flux_e);
      else
        frame.add_point(t.x, t.y, t.flux_e);
      stars.push_back(t);
    }
  return stars;
}

class SourcePlaces : public ::testing::TestWithParam<bool> {};

// Brute-force images of points and of trails of 6 px: all are found, their normalised errors have
// the mean square 1, and those of 50,000 e- lie within 0.02 px.
TEST_P(SourcePlaces, AreAsGoodAsStated) {
  FrameHeader header = simulated::camera_header(800, 700, 5000, 0.3, 1, false);
  simulated::SimulatedFrame frame(header, 800, 700, 200, 5);
  const auto stars = add_grid(frame, 800, 700, 2000, 50'000, GetParam());
  const CountImage counts = frame.expose();
  Threads one(1), three(3);
  const auto sources = find_star_sources(counts, settings_of(header), one);
  const auto again = find_star_sources(counts, settings_of(header), three);
  ASSERT_EQ(sources.size(), again.size());
  for (std::size_t i = 0; i < sources.size(); ++i) {
    EXPECT_EQ(sources[i].x_px, again[i].x_px);
    EXPECT_EQ(sources[i].flux, again[i].flux);
  }
  const SourceGrid grid(sources, 800, 700);
  double sum = 0.0, flux = 0.0, bright = 0.0;
  int bright_count = 0;
  for (const Truth& t : stars) {
    const int k = grid.nearest({t.x, t.y}, 1.0);
    ASSERT_GE(k, 0) << t.flux_e;
    const PlateSource& s = sources[std::size_t(k)];
    EXPECT_FALSE(s.saturated);
    const double dx = s.x_px - t.x, dy = s.y_px - t.y;
    const auto& c = s.covariance_px2;
    const double det = c[0] * c[2] - c[1] * c[1];
    sum += (c[2] * dx * dx - 2 * c[1] * dx * dy + c[0] * dy * dy) / det;
    flux += (s.flux - t.flux_e) / t.flux_e;
    if (t.flux_e < 25'000) continue;
    bright += dx * dx + dy * dy;
    ++bright_count;
  }
  const double nees = sum / (2 * double(stars.size()));
  EXPECT_GT(nees, 0.75);
  EXPECT_LT(nees, 1.3);
  EXPECT_LT(std::sqrt(bright / bright_count), 0.025);
  EXPECT_NEAR(flux / double(stars.size()), 0.0, 0.02);
  EXPECT_LE(sources.size(), stars.size() + 3);
}

INSTANTIATE_TEST_SUITE_P(PointsAndTrails, SourcePlaces, ::testing::Bool());

TEST(StarSources, SaturatedStarsAreRankedByBrightness) {
  FrameHeader header = simulated::camera_header(600, 600, 5000, 0.3, 1, false);
  simulated::SimulatedFrame frame(header, 600, 600, 200, 6);
  for (int i = 0; i < 6; ++i) frame.add_point(60.2 + 90 * i, 300.4, 2e5 * std::pow(4, i));
  const auto counts = frame.expose();
  Threads one(1);
  StarSourceSettings settings = settings_of(header);
  settings.saturation_dn = 60'000;
  const auto sources = find_star_sources(counts, settings, one);
  ASSERT_GE(sources.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    EXPECT_TRUE(sources[std::size_t(i)].saturated);
    EXPECT_NEAR(sources[std::size_t(i)].x_px, 60.2 + 90 * (5 - i), 0.3);
    EXPECT_NEAR(sources[std::size_t(i)].y_px, 300.4, 0.3);
  }
}

// Whatever is in a frame, the search ends and its numbers are finite.
TEST(StarSources, HardFrames) {
  Threads one(1);
  for (const auto& [columns, rows] : {std::pair{1, 1}, {1, 500}, {500, 1}, {3, 3}, {300, 200}})
    for (const int kind : {0, 1, 2, 3}) {
      CountImage counts(columns, rows, kind == 1 ? 65535 : 0);
      for (std::size_t i = 0; i < counts.pixels.size() && kind >= 2; ++i)
        counts.pixels[i] = kind == 2
                               ? std::uint16_t(i * 40503u >> 3)  // wild
                               : std::uint16_t(i / std::size_t(columns) < rows / 2u ? 65535 : 100);
      for (const PlateSource& s : find_star_sources(counts, {}, one)) {
        EXPECT_TRUE(std::isfinite(s.x_px + s.y_px + s.flux + s.covariance_px2[0] +
                                  s.covariance_px2[1] + s.covariance_px2[2]));
      }
    }
}

}  // namespace
}  // namespace dmise
