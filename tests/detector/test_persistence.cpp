#include "core/detector/persistence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "core/base/error.h"
#include "core/detector/exposure/expose.h"
#include "tests/support/detector_of.h"

namespace dmise {
namespace {

constexpr double exposure_s = 2.0, idle_s = 1.0;
constexpr Detector trapping = detector_of({.dark_e_per_s = 1,
                                           .read_noise_e = 3,
                                           .full_well_e = 50000,
                                           .bias_dn = 100,
                                           .persistence_fraction = 0.02,
                                           .persistence_s = 1.0});

ExpectedElectronImage light_of(std::uint32_t frame) {
  ExpectedElectronImage light(60, 50, 200.0f);
  light.at(int(frame * 7 % 60), 25) = 30000.0f;
  return light;
}

CountImage expose_frame(std::uint32_t frame, DetectorMemory* memory, const Detector& d = trapping) {
  Threads one(1);
  CountImage counts;
  expose(light_of(frame), d, {1, "s", frame, exposure_s, idle_s}, {}, one, counts, nullptr,
         {.memory = memory});
  return counts;
}

// tau = 1 s at a cadence of 3 s: exp(-3 w) <= 1e-4 for w = 4 frames.
TEST(PersistenceMemory, AWindowLeavesATenThousandth) {
  EXPECT_EQ(persistence_window(1.0, 3.0), 4u);
  EXPECT_EQ(persistence_window(1e-3, 1.0), 1u);
  EXPECT_EQ(persistence_first_frame(trapping, 3.0, 1), 1u);
  EXPECT_EQ(persistence_first_frame(trapping, 3.0, 8), 1u);
  EXPECT_EQ(persistence_first_frame(trapping, 3.0, 9), 5u);
  EXPECT_EQ(persistence_first_frame(trapping, 3.0, 14), 9u);
  EXPECT_EQ(persistence_first_frame(Detector{}, 3.0, 14), 14u);
}

// Whoever starts in the middle exposes the frames of the look-back first and has the same bytes.
TEST(PersistenceMemory, AFrameDependsOnNothingBeforeItsLookBack) {
  DetectorMemory whole;
  for (std::uint32_t frame = 1; frame <= 20; ++frame) {
    const CountImage counts = expose_frame(frame, &whole);
    DetectorMemory rejoined;
    CountImage again;
    for (auto f = persistence_first_frame(trapping, exposure_s + idle_s, frame); f <= frame; ++f)
      again = expose_frame(f, &rejoined);
    ASSERT_EQ(counts.pixels, again.pixels) << frame;
  }
}

// Charge trapped in one bright exposure returns over the next ones: a geometric series, to 1e-4.
TEST(PersistenceMemory, ReturnsAllThatItTrappedAndNoMore) {
  Detector d = trapping;
  d.dark_e_per_s = d.read_noise_e = 0;
  d.persistence_s = 10;
  DetectorMemory memory;
  Threads one(1);
  CountImage counts;
  double returned = 0;
  const double pixels = 100 * 100, trapped = 0.02 * 40000;
  for (std::uint32_t frame = 1; frame <= 60; ++frame) {
    const ExpectedElectronImage light(100, 100, frame == 1 ? 40000.0f : 0.0f);
    expose(light, d, {1, "s", frame, exposure_s, 0.0}, {}, one, counts, nullptr,
           {.memory = &memory});
    const double mean =
        std::accumulate(counts.pixels.begin(), counts.pixels.end(), 0.0) / pixels - 100;
    if (frame == 1) {  // what is trapped is missing
      EXPECT_NEAR(mean, 40000 - trapped, 4 * std::sqrt(40000 / pixels));
      continue;
    }
    returned += mean;
    const double expected =
        trapped * std::exp(-exposure_s * (frame - 2) / 10.0) * (1 - std::exp(-exposure_s / 10.0));
    EXPECT_NEAR(mean, expected, 4 * std::sqrt(expected / pixels) + 1e-4 * trapped) << frame;
  }
  EXPECT_NEAR(returned, trapped, 4 * std::sqrt(trapped / pixels) + 1e-4 * trapped);
}

TEST(PersistenceMemory, AFrameOutOfTurnIsRefused) {
  DetectorMemory memory;
  expose_frame(1, &memory);
  EXPECT_THROW(expose_frame(3, &memory), Error);
}

TEST(PersistenceMemory, AFullPixelTrapsNoMoreThanItHolds) {
  std::vector<float> trapped(2);
  caught(0.1, 1000, std::vector<float>{500.0f, 1e6f}, trapped);
  EXPECT_FLOAT_EQ(trapped[0], 50);
  EXPECT_FLOAT_EQ(trapped[1], 100);
}

}  // namespace
}  // namespace dmise
