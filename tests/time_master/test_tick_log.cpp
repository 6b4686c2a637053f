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

// A sensor computes 4 s of a tick, then fusion 1 s: who ends the tick is not who was waited for.
TEST(TickLog, BooksWaitingToWhoComputesAndNotToWhoIsLast) {
  TickLog log;
  EXPECT_FALSE(log.is_wait_due(seconds(9)));  // before the start
  log.grant(0, 0, seconds(10));
  EXPECT_FALSE(log.is_wait_due(seconds(10)));
  EXPECT_TRUE(log.is_wait_due(seconds(14)));
  log.wait({"camera", "telescope"}, seconds(14));
  log.wait({"fusion"}, seconds(15));
  log.settle(0, seconds(15), "fusion");
  log.wait({}, seconds(20));     // paused
  log.grant(0, 1, seconds(25));  // until then the clock kept its pace
  log.wait({"fusion"}, seconds(27));
  const std::map<std::string, double> expected{
      {"camera", 4.0}, {"fusion", 3.0}, {"telescope", 4.0}};
  EXPECT_EQ(log.waited_for_s(), expected);
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
