#include <gtest/gtest.h>

#include "time-master/tick_log.h"

namespace dmise {
namespace {

using std::chrono::seconds;

TEST(TickLog, SaysWhenTicksWereGrantedAndWhoWasLast) {
  TickLog log;
  log.settle(0, seconds(1), "early");  // before the start
  log.grant(0, -1, seconds(9));
  log.grant(0, 1, seconds(10));
  log.settle(-1, seconds(11), "orbit");
  log.settle(0, seconds(12), "alpha");
  log.grant(0, 3, seconds(13));
  log.settle(2, seconds(15), "beta");
  const std::vector<TickRecord> expected{
      {0, 0.0, 2.0, "alpha"}, {1, 0.0, 5.0, "beta"}, {2, 3.0, 5.0, "beta"}};
  EXPECT_EQ(log.records(), expected);
}

TEST(TickLog, BeginsWhereAnInterruptedRunGoesOn) {
  TickLog log;
  log.grant(7, 6, seconds(1));
  log.grant(7, 8, seconds(2));
  log.settle(8, seconds(3), "alpha");
  ASSERT_EQ(log.records().size(), 2u);
  EXPECT_EQ(log.records()[0].tick, 7);
}

TEST(TickLog, KeepsTheLatestTicks) {
  TickLog log;
  for (Tick tick = 0; tick < 30'000; ++tick) {
    log.grant(0, tick, seconds(tick));
    log.settle(tick, seconds(tick), "alpha");
  }
  EXPECT_EQ(log.records().size(), 10'000u);
  EXPECT_EQ(log.records().back().tick, 29'999);
}

}  // namespace
}  // namespace dmise
