#include "nodes/runtime/observability/tick_rate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

// A clock of 1 s ticks at 13 times real time: nine ticks at once, then one with frames. It is asked
// twice a second.
TEST(TickRate, IsSteadyWhereTheClockIs) {
  TickRate rate;
  double least = 1e9, most = 0.0;
  for (double now_s = 0.0; now_s < 120.0; now_s += 0.5) {
    const double cycles = 13.0 * now_s / 40.0;  // 40 ticks each, 38 of them in a tenth of the time
    const double within = cycles - std::floor(cycles);
    rate.take(Tick(40 * std::floor(cycles) +
                   (within < 0.9 ? 2 * within / 0.9 : 2 + 380 * (within - 0.9))),
              now_s);
    if (now_s < 20.0) continue;
    least = std::min(least, rate.ticks_per_s());
    most = std::max(most, rate.ticks_per_s());
  }
  EXPECT_GT(least, 13.0 * 0.75);
  EXPECT_LT(most, 13.0 * 1.25);
}

TEST(TickRate, OfRareTicksIsTheirs) {
  TickRate rate;
  for (int k = 0; k <= 1000; ++k) {
    rate.take(Tick(k / 60), double(k));
    if (k > 120) {
      ASSERT_NEAR(rate.ticks_per_s(), 1.0 / 60, 1e-9) << k;
    }
  }
}

TEST(TickRate, FallsToNothingAndBeginsAnew) {
  TickRate rate;
  for (int k = 0; k <= 40; ++k) rate.take(Tick(10 * k), double(k));
  EXPECT_NEAR(rate.ticks_per_s(), 10.0, 1e-9);
  for (int k = 41; k < 60; ++k) rate.take(400, double(k));
  EXPECT_EQ(rate.ticks_per_s(), 0.0);
  rate.reset();
  rate.take(400, 100.0);
  EXPECT_EQ(rate.ticks_per_s(), 0.0);
  rate.take(404, 102.0);
  EXPECT_EQ(rate.ticks_per_s(), 2.0);
  rate.take(3, 103.0);  // another run
  EXPECT_EQ(rate.ticks_per_s(), 0.0);
}

}  // namespace
}  // namespace dmise
