#include "core/detection/source/beamlets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/detection/pixels/components.h"
#include "core/detection/source/beamlet_kernels.h"
#include "core/detection/source/line_search.h"
#include "tests/detection/filtered_step.h"
#include "tests/support/simulated_frame.h"

// Sums of a filtered frame along lines.
namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr double sky_e = 1500.0;

/// Noise of unit variance through the matched filter, as `find_components` leaves it.
FilteredFrame filtered_noise(int columns, int rows, unsigned seed) {
  const auto header = camera_header(columns, rows, 1663, 0.6, 1e-3, true);
  SimulatedFrame frame(header, columns, rows, sky_e, seed);
  const CountImage counts = frame.expose();
  Threads threads;
  const Background background(counts, 64, threads);
  const double sigma = header.psf_fwhm_px / std::sqrt(8 * std::log(2.0));
  FilteredFrame filtered(columns, rows, std::sqrt(sigma * sigma + 1.0 / 12));
  find_components(counts, background, filtered.sigma_px, 3, 5, threads, &filtered);
  return filtered;
}

TEST(Beamlets, ASumAlongATrailHasTheNoiseItStates) {
  const FilteredFrame frame = filtered_noise(1500, 1500, 3);
  std::mt19937_64 random(5);
  const auto uniform = [&](double a, double b) {
    return a + (b - a) * double(random() >> 11) * 0x1p-53;
  };
  for (const double length : {10.0, 60.0, 400.0}) {
    double squares = 0.0;
    constexpr int trails = 4000;
    for (int i = 0; i < trails; ++i) {
      Trail t;
      t.length_px = length;
      t.angle_rad = uniform(0, pi);
      t.x_px = uniform(205, 1295), t.y_px = uniform(205, 1295);
      const double snr = snr_along(frame, t);
      squares += snr * snr;
    }
    EXPECT_NEAR(std::sqrt(squares / trails), 1.0, 0.06) << length;
  }
}

TEST(Beamlets, ALineOfAnyDirectionIsFoundWithMostOfItsSignal) {
  for (int degrees = 0; degrees < 180; degrees += 7) {
    FilteredFrame frame(600, 500, 0.8);
    for (int y = 0; y < 500; ++y)
      for (int x = 0; x < 600; ++x) frame.row(y)[x] = test::step_of(0, (x + y) % 2 != 0);
    Trail t;
    t.x_px = 290.3, t.y_px = 255.7, t.length_px = 180, t.angle_rad = degrees * deg;
    for (int y = 0; y < 500; ++y)
      for (int x = 0; x < 600; ++x) {
        const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
        const double dx = x - t.x_px, dy = y - t.y_px, across = dy * c - dx * s;
        if (std::abs(dx * c + dy * s) > 90 || std::abs(across) > 5) continue;
        frame.row(y)[x] =
            test::step_of(float(1.5 * std::exp(-across * across / 2.56)), (x + y) % 2 != 0);
      }
    Threads threads;
    const auto beamlets = find_beamlets(frame, TurnedFrame(frame), 4, SimdLevel::sse2, threads);
    ASSERT_FALSE(beamlets.empty()) << degrees;
    const double whole = snr_along(frame, t);
    EXPECT_GT(beamlets.front().snr, 0.7 * whole) << degrees;
    Trail start;
    const Beamlet& b = beamlets.front();
    start.x_px = (b.x1 + b.x2) / 2, start.y_px = (b.y1 + b.y2) / 2;
    start.length_px = std::hypot(b.x2 - b.x1, b.y2 - b.y1);
    start.angle_rad = std::atan2(b.y2 - b.y1, b.x2 - b.x1);
    const Trail best = climbed(frame, start);
    EXPECT_GT(snr_along(frame, best), 0.97 * whole) << degrees;
    EXPECT_NEAR(best.length_px, 180, 9) << degrees;
  }
}

TEST(Beamlets, AreTheSameOnEveryInstructionSetAndNumberOfThreads) {
  const FilteredFrame frame = filtered_noise(700, 530, 9);
  Threads one, three(3);
  const auto expected = find_beamlets(frame, TurnedFrame(frame), 3.5, SimdLevel::sse2, one);
  ASSERT_GT(expected.size(), 20u);
  for (const SimdLevel level : {SimdLevel::sse2, SimdLevel::avx2, SimdLevel::avx512}) {
    if (level > best_simd_level()) continue;
    const auto other = find_beamlets(frame, TurnedFrame(frame), 3.5, level, three);
    ASSERT_EQ(other.size(), expected.size());
    for (std::size_t i = 0; i < other.size(); ++i) {
      EXPECT_EQ(other[i].snr, expected[i].snr);
      EXPECT_EQ(other[i].x1, expected[i].x1);
      EXPECT_EQ(other[i].y2, expected[i].y2);
    }
  }
}

// Sums of four strips at once are those of two and two, and of these two.
TEST(Beamlets, FourStripsAreJoinedAsTwoAndTwo) {
  constexpr std::size_t columns = 300, zeros = 400;
  constexpr std::int16_t large = 45;
  std::mt19937_64 random(11);
  using Rows = std::array<std::vector<std::int16_t>, 4>;
  for (const std::size_t shift : {0u, 1u, 3u, 100u}) {
    Rows start;
    for (auto& row : start) {
      for (std::size_t x = 0; x < columns; ++x)
        row.push_back(std::int16_t(int(random() % 61) - 30));
      row.resize(columns + zeros);
    }
    const auto at = [](const std::vector<std::int16_t>& row, std::size_t x) { return int(row[x]); };
    const auto half = [&](std::size_t upper, std::size_t odd, std::size_t x) {
      return at(start[upper], x) + at(start[upper + 1], x + shift + odd);
    };
    for (const SimdLevel level : {SimdLevel::sse2, SimdLevel::avx2, SimdLevel::avx512}) {
      if (level > best_simd_level()) continue;
      Rows sums = start;
      std::int16_t* rows[4] = {sums[0].data(), sums[1].data(), sums[2].data(), sums[3].data()};
      std::vector<BeamletHit> whole(4 * (columns + beamlet_spare)), halves = whole;
      BeamletLeast least;
      std::fill_n(least.whole, 4, large);
      std::fill_n(least.halves, 2, large);
      BeamletHits hits{whole.data(), halves.data()};
      kernel_of(level, sse2::join_four, avx2::join_four, avx512::join_four)(rows, shift, 0, columns,
                                                                            least, hits);
      std::size_t in_whole = 0, in_halves = 0;
      for (std::size_t x = 0; x < columns; ++x)
        for (std::size_t r = 0; r < 4; ++r) {
          const int sum = half(0, r / 2, x) + half(2, r / 2, x + 2 * shift + (r + 1) / 2);
          ASSERT_EQ(at(sums[r], x), sum) << shift << " " << r << " " << x;
          in_whole += sum >= large;
          in_halves += half(r / 2 * 2, r % 2, x) >= large;
        }
      EXPECT_EQ(hits.in_whole, in_whole);
      // Those in the lower half that no line over four strips reaches are in no hit.
      EXPECT_LE(hits.in_halves, in_halves);
      for (std::size_t i = 0; i < hits.in_halves; ++i) {
        const BeamletHit& hit = halves[i];
        EXPECT_EQ(hit.sum,
                  half(std::size_t(hit.row) / 2 * 2, std::size_t(hit.row) % 2, hit.column));
      }
    }
  }
}

TEST(Beamlets, FramesOfAnySizeAreSearched) {
  Threads threads;
  for (const auto& [columns, rows] : {std::array{1, 1}, std::array{1, 900}, std::array{900, 1},
                                      std::array{7, 7}, std::array{8, 9}, std::array{1025, 17}}) {
    FilteredFrame frame(columns, rows, 0.8);
    std::fill(frame.snr.begin(), frame.snr.end(), std::int8_t(FilteredFrame::most));
    const auto beamlets = find_beamlets(frame, TurnedFrame(frame), 4, best_simd_level(), threads);
    for (const Beamlet& b : beamlets) EXPECT_TRUE(std::isfinite(b.snr));
    std::fill(frame.snr.begin(), frame.snr.end(), std::int8_t(0));
    EXPECT_TRUE(find_beamlets(frame, TurnedFrame(frame), 4, best_simd_level(), threads).empty());
  }
}

/// Faint stars are light and scatter of the sky: their mean, a gradient of it and their scatter go,
/// what is hidden stays so, and noise that has no more than its own scatter is not made stronger.
TEST(FilteredFrame, IsFlattenedToNoise) {
  for (const int threads : {1, 3}) {
    Threads pool(threads);
    FilteredFrame frame(500, 300, 0.8);
    std::mt19937_64 random(3);
    std::normal_distribution<float> normal;
    for (int y = 0; y < 300; ++y)
      for (int x = 0; x < 500; ++x) {
        const float scatter = x < 250 ? 1.0f : 1.6f;
        frame.row(y)[x] =
            test::step_of(0.5f + 0.002f * float(x) + scatter * normal(random), (x + y) % 2 != 0);
      }
    for (int y = 0; y < 300; y += 7) frame.hide(y, 100, 130);
    frame.flatten(pool);
    for (const auto& [x0, x1] : {std::array{20, 95}, std::array{140, 165}, std::array{300, 480}}) {
      double n = 0, sum = 0, squares = 0;
      for (int y = 20; y < 280; ++y)
        for (int x = x0; x < x1; ++x) {
          const double v = double(frame.row(y)[x]) / FilteredFrame::steps;
          n += 1, sum += v, squares += v * v;
        }
      EXPECT_NEAR(sum / n, 0.0, 0.03) << x0;
      EXPECT_NEAR(std::sqrt(squares / n), 1.0, 0.03) << x0;
    }
    for (int y = 0; y < 300; y += 7) EXPECT_EQ(frame.row(y)[115], 0);
  }
}

}  // namespace
}  // namespace dmise
