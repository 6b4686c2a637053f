#include "core/detector/frame_transfer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/detector/exposure/expected_noise.h"
#include "core/detector/exposure/expose.h"
#include "tests/support/detector_of.h"

namespace dmise {
namespace {

constexpr int columns = 301, rows = 200;  // several pieces of work
constexpr double exposure_s = 2.0, transfer_s = 0.5;
const Exposure exposure{.seed = 1, .sensor = "s", .frame = 1, .exposure_s = exposure_s};

/// Counts are whole hundredths of an electron.
CountImage read_out(const ExpectedElectronImage& light, int thread_count = 1) {
  Detector d = detector_of({.gain_e_per_dn = 0.01});
  d.frame_transfer_s = transfer_s;
  EffectSet effects;
  effects.set(PhotonNoise::facts, false);
  Threads threads(thread_count);
  CountImage counts;
  expose(light, d, exposure, effects, threads, counts);
  return counts;
}

// A pixel of row y passes y rows, each for transfer / rows: under even light L it holds
// L (1 + y transfer / (rows exposure)).
TEST(FrameTransfer, EvenLightGrowsWithTheRowsPassed) {
  for (const int threads : {1, 3}) {
    const CountImage counts = read_out(ExpectedElectronImage(columns, rows, 400.0f), threads);
    for (int y = 0; y < rows; ++y)
      for (const int x : {0, 17, columns - 1})
        ASSERT_NEAR(counts.at(x, y) * 0.01, 400.0 * (1 + y * transfer_s / (rows * exposure_s)),
                    0.011)
            << x << " " << y;
  }
}

// Ruyten 1999: a star smears along its column, on the side that is read after it, by its light
// times the time of a row over the exposure.
TEST(FrameTransfer, AStarLeavesAnEvenTrailBehindIt) {
  ExpectedElectronImage light(columns, rows);
  light.at(40, 120) = 600.0f;
  const CountImage counts = read_out(light);
  for (int y = 0; y < rows; ++y) {
    const double smear = y > 120 ? 600.0 * transfer_s / (rows * exposure_s) : 0.0;
    EXPECT_NEAR(counts.at(40, y) * 0.01, y == 120 ? 600.0 : smear, 0.006) << y;
    EXPECT_EQ(counts.at(41, y), 0) << y;
  }
}

TEST(FrameTransfer, ItsLightHasShotNoise) {
  Detector d = detector_of({});
  d.frame_transfer_s = transfer_s;
  Threads one(1);
  const auto noise =
      expected_noise(ExpectedElectronImage(columns, rows, 400.0f), d, exposure, {}, one);
  const double last_e = 400.0 * (1 + (rows - 1) * transfer_s / (rows * exposure_s));
  EXPECT_NEAR(noise.at(5, rows - 1), std::sqrt(last_e + 1.0 / 12), 1e-4 * std::sqrt(last_e));
}

}  // namespace
}  // namespace dmise
