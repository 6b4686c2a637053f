#include "time-master/pace.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "tests/time_master/coordinators.h"

namespace dmise {
namespace {

using namespace test;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

/// Paused, and all granted ticks are done.
bool is_frozen(const Coordinator& master) {
  return master.paused() && master.settled() >= master.granted();
}

CoordinatorOptions real_time(double factor, int window = 1) {
  auto o = options({"camera"}, 9, window);
  o.silent_after = std::chrono::hours(1);
  o.pace = {.tick_length = {5'000'000'000}, .factor = factor};
  return o;
}

TEST(Pace, GrantsATickWhenTheWallClockReachesIt) {
  Coordinator master = started(real_time(2.0, 4));  // ticks of 5 s at twice real time
  EXPECT_EQ(master.granted(), 0);
  EXPECT_EQ(master.next_due(), milliseconds(2500));
  master.done("camera", 0, seconds(1));
  master.check(milliseconds(2499));
  EXPECT_EQ(master.granted(), 0);
  EXPECT_THAT(master.holding(), IsEmpty());  // the wall clock does
  master.check(milliseconds(2500));
  EXPECT_EQ(master.granted(), 1);
  EXPECT_EQ(master.pace().overruns(), 0u);
}

TEST(Pace, CountsATickThatIsNotOverWhenTheNextIsDueAndCatchesUp) {
  Coordinator master = started(real_time(1.0));
  master.done("camera", 0, seconds(4));
  master.check(seconds(5));
  master.done("camera", 1, seconds(17));  // due until 10 s; ticks 2 and 3 wait already
  EXPECT_EQ(master.pace().overruns(), 1u);
  EXPECT_EQ(master.pace().worst_lag(), seconds(7));
  EXPECT_EQ(master.granted(), 2);
  master.done("camera", 2, seconds(18));
  EXPECT_EQ(master.pace().overruns(), 2u);  // it should have been over at 15 s
  EXPECT_EQ(master.granted(), 3);
  master.done("camera", 3, seconds(19));
  EXPECT_EQ(master.pace().overruns(), 2u);
  EXPECT_EQ(master.granted(), 3);  // tick 4 is due at 20 s
}

TEST(Pace, IsExactForTicksOfAMicrosecondAndOfAnHour) {
  for (const std::int64_t tick_ns : {std::int64_t(1000), std::int64_t(3'600'000'000'000)}) {
    Pace pace({.tick_length = {tick_ns}, .factor = 1.0});
    pace.start(Instant{7});
    for (const Tick tick : {Tick(1), Tick(3), Tick(1000), Tick(87660)}) {  // 87,660 h: ten years
      EXPECT_EQ(pace.limit(Instant{7 + tick * tick_ns - 1}), tick - 1);
      EXPECT_EQ(pace.limit(Instant{7 + tick * tick_ns}), tick);
    }
  }
}

TEST(Pace, RefusesAFactorThatIsNone) {
  Pace pace({.factor = 1.0});
  for (const double factor : {-1.0, std::nan(""), double(INFINITY), 1.1e6}) {
    EXPECT_THROW(Pace({.factor = factor}), ConfigError);
    EXPECT_THROW(pace.change(factor, 0, Instant{0}), ConfigError);
  }
  EXPECT_EQ(pace.factor(), 1.0);
}

TEST(PaceChange, WhatIsLeftOfATickPassesAtTheNewFactor) {
  Coordinator master = started(real_time(1.0, 4));  // ticks of 5 s
  master.done("camera", 0, seconds(1));
  master.change_pace(10.0, seconds(3));  // two fifths of the tick are left: 2 s, now 0.2 s
  EXPECT_EQ(master.next_due(), milliseconds(3200));
  master.check(milliseconds(3200));
  EXPECT_EQ(master.granted(), 1);
  EXPECT_EQ(master.next_due(), milliseconds(3700));
  master.done("camera", 1, milliseconds(3300));
  master.change_pace(0.1, milliseconds(3600));  // a fifth is left, of 50 s
  EXPECT_EQ(master.next_due(), milliseconds(13600));
  EXPECT_EQ(master.pace().overruns(), 0u);
}

TEST(PaceChange, ALateClockDoesNotCatchUp) {
  Coordinator master = started(real_time(1.0));
  master.check(seconds(100));  // the camera is late by 19 ticks
  master.change_pace(2.0, seconds(100));
  master.done("camera", 0, seconds(101));
  EXPECT_EQ(master.pace().overruns(), 1u);
  EXPECT_EQ(master.granted(), 1);  // was due at 100 s
  EXPECT_EQ(master.pace().worst_lag(), seconds(1));
  master.done("camera", 1, seconds(102));
  EXPECT_EQ(master.granted(), 1);  // tick 2 is due at 102.5 s
}

TEST(PaceChange, AsFastAsPossibleAndBack) {
  Coordinator master = started(real_time(1e-3, 4));
  EXPECT_EQ(master.granted(), 0);
  master.change_pace(0.0, seconds(1));
  EXPECT_EQ(master.granted(), 3);
  EXPECT_FALSE(master.next_due());
  master.change_pace(1.0, seconds(2));
  for (const Tick tick : {0, 1, 2, 3}) master.done("camera", tick, seconds(6));
  EXPECT_EQ(master.granted(), 3);
  EXPECT_EQ(master.next_due(), seconds(7));
  // Granted before real time counted: when they were due is not known.
  EXPECT_EQ(master.pace().overruns(), 0u);
}

// Ticks that last longer than a clock can count are not due in this run.
TEST(PaceChange, ToTheLeastFactorThatIsOne) {
  for (const double factor : {1e-9, 1e-12, 1e-300, 5e-324}) {
    Coordinator master = started(real_time(1.0, 4));
    for (int times = 0; times < 3; ++times) master.change_pace(factor, seconds(12 + times));
    const Tick granted = master.granted();
    master.check(std::chrono::minutes(30));
    EXPECT_EQ(master.granted(), granted) << factor;
    master.change_pace(1.0, std::chrono::minutes(30));
    master.check(std::chrono::minutes(30) + seconds(6));
    for (Tick tick = 0; tick <= granted; ++tick)
      master.done("camera", tick, std::chrono::minutes(30) + seconds(7));
    EXPECT_GT(master.granted(), granted) << factor;
  }
}

TEST(PaceChange, LeavesAPauseAsItIs) {
  Coordinator master = started(real_time(1.0, 4));
  master.pause();
  master.done("camera", 0, seconds(1));
  master.change_pace(0.0, seconds(100));
  EXPECT_EQ(master.granted(), 0);
  master.change_pace(2.0, seconds(100));
  master.go_on(seconds(200));
  EXPECT_EQ(master.granted(), 1);
  EXPECT_EQ(master.next_due(), milliseconds(202500));
}

TEST(PaceChange, BeforeTheStartItIsThatOfTheStart) {
  Coordinator master(real_time(1.0, 4));
  master.change_pace(5.0, seconds(1));
  master.join(node("camera"), seconds(2));
  master.ready("camera", seconds(10));
  EXPECT_EQ(master.granted(), 0);
  EXPECT_EQ(master.next_due(), seconds(11));
}

TEST(Pause, StepsAheadOfRealTimeAreNotWaitedForAfterwards) {
  auto options = real_time(1.0);
  options.last_tick = 99;
  Coordinator master = started(options);
  master.pause();
  master.step(50, seconds(1));
  for (Tick tick = 0; tick <= 50; ++tick) master.done("camera", tick, seconds(2));
  EXPECT_TRUE(is_frozen(master));
  master.go_on(seconds(3));
  EXPECT_EQ(master.next_due(), seconds(8));  // a tick of 5 s later, not after 255 s
}

TEST(Pause, HoldsAtTheLastTickGrantedAndGoesOn) {
  Coordinator master = started(options({"orbit", "camera"}, 9, 2));
  EXPECT_EQ(master.granted(), 1);
  master.pause();
  for (const char* name : {"orbit", "camera"}) master.done(name, 0);
  EXPECT_FALSE(is_frozen(master));  // tick 1 was granted and is still being made
  EXPECT_EQ(master.granted(), 1);
  for (const char* name : {"orbit", "camera"}) master.done(name, 1);
  EXPECT_TRUE(is_frozen(master));
  EXPECT_THAT(master.holding(), IsEmpty());
  master.go_on();
  EXPECT_EQ(master.granted(), 3);
}

TEST(Pause, StepsTickByTick) {
  Coordinator master = started(options({"camera"}, 9, 4));
  master.pause();
  master.step(1);
  EXPECT_EQ(master.granted(), 3);  // nothing beyond the window of the slowest
  for (Tick tick = 0; tick <= 3; ++tick) master.done("camera", tick);
  EXPECT_EQ(master.granted(), 4);
  master.done("camera", 4);
  EXPECT_TRUE(is_frozen(master));
  master.step(2);
  EXPECT_EQ(master.granted(), 6);
}

TEST(Pause, FreezesAtATickToCome) {
  Coordinator master = started(options({"camera"}, 9, 4));
  master.pause(5);
  for (Tick tick = 0; tick <= 5; ++tick) master.done("camera", tick);
  EXPECT_EQ(master.granted(), 5);
  EXPECT_TRUE(is_frozen(master));
}

TEST(Pause, TicksUntilOneToComeKeepThePace) {
  Coordinator master = started(real_time(1.0));  // ticks of 5 s
  master.pause(2, seconds(1));
  EXPECT_FALSE(master.paused());
  master.done("camera", 0, seconds(1));
  EXPECT_EQ(master.granted(), 0);
  EXPECT_EQ(master.next_due(), seconds(5));
  master.check(seconds(5));
  EXPECT_EQ(master.granted(), 1);
  master.done("camera", 1, seconds(11));  // late by a second
  EXPECT_EQ(master.pace().overruns(), 1u);
  EXPECT_EQ(master.granted(), 2);
  EXPECT_TRUE(master.paused());
  EXPECT_FALSE(master.next_due());
  master.done("camera", 2, seconds(100));
  EXPECT_EQ(master.pace().overruns(), 1u);
  // From one pause to another: no tick is late because of the first.
  master.pause(4, seconds(200));
  EXPECT_FALSE(master.paused());
  master.check(seconds(200));
  EXPECT_EQ(master.granted(), 3);
  master.done("camera", 3, seconds(201));
  EXPECT_EQ(master.next_due(), seconds(205));
  master.check(seconds(205));
  master.done("camera", 4, seconds(206));
  EXPECT_TRUE(is_frozen(master));
  EXPECT_EQ(master.granted(), 4);
  master.step(2, seconds(207));  // at once
  master.done("camera", 5, seconds(207));
  EXPECT_EQ(master.granted(), 6);
  EXPECT_EQ(master.pace().overruns(), 1u);
}

TEST(Pause, IsNoOverrunOfRealTime) {
  Coordinator master = started(real_time(1.0));
  master.pause();
  master.done("camera", 0, seconds(3));
  master.check(seconds(100));
  EXPECT_EQ(master.granted(), 0);
  master.go_on(seconds(100));
  EXPECT_EQ(master.granted(), 1);
  master.done("camera", 1, seconds(104));
  EXPECT_EQ(master.next_due(), seconds(105));
  EXPECT_EQ(master.pace().overruns(), 0u);
}

TEST(Pause, HoldsTheClockBeforeATickAtWhichNobodyWorks) {
  auto request = node("camera", {});
  request.node.schedule = {.period = 2, .offset = 1};
  Coordinator master(options({"camera"}, 3, 1));
  master.pause();
  master.join(request);
  master.ready("camera");
  EXPECT_EQ(master.settled(), master.granted());
  EXPECT_EQ(master.granted(), -1);
  master.step(1);
  EXPECT_EQ(master.settled(), 0);  // over as soon as it is granted
  master.go_on();
  for (const Tick tick : {1, 3}) master.done("camera", tick);
  EXPECT_EQ(master.settled(), 3);
  EXPECT_EQ(master.phase(), Phase::ended);
}

TEST(EndEarly, LeavesNoTickHalfDone) {
  Coordinator master = started(options({"orbit", "camera"}, 9, 2));
  master.done("orbit", 0);
  master.end_early("enough");
  EXPECT_EQ(master.phase(), Phase::running);
  master.done("orbit", 1);
  for (const Tick tick : {0, 1}) master.done("camera", tick);
  EXPECT_EQ(master.phase(), Phase::ended);
  EXPECT_EQ(master.granted(), 1);
  EXPECT_EQ(master.cause(), "enough");
}

TEST(EndEarly, EndsAFrozenRunAtOnce) {
  Coordinator master = started(options({"camera"}));
  master.pause();
  master.done("camera", 0);
  master.end_early("enough");
  EXPECT_EQ(master.phase(), Phase::ended);
}

TEST(Schedule, ANodeHoldsNobodyBetweenItsTicks) {
  Coordinator master(options({"orbit", "camera"}, 9, 1));
  master.join(node("orbit", {"state"}));
  auto camera = node("camera", {}, {"state"});
  camera.node.schedule = {.period = 3, .offset = 2};  // ticks 2, 5, 8
  master.join(camera);
  master.ready("orbit");
  master.ready("camera");
  for (Tick tick = 0; tick <= 2; ++tick) {
    ASSERT_EQ(master.granted(), tick);
    master.done("orbit", tick);
  }
  EXPECT_EQ(master.granted(), 2);
  EXPECT_THAT(master.holding(), ElementsAre("camera"));
  master.done("camera", 2);
  EXPECT_EQ(master.granted(), 3);
  for (Tick tick = 3; tick <= 9; ++tick) {
    master.done("orbit", tick);
    if (tick == 5 || tick == 8) master.done("camera", tick);
  }
  EXPECT_EQ(master.phase(), Phase::ended);  // after tick 8 the camera had nothing left to do
}

TEST(Schedule, RefusesOneThatIsNone) {
  Coordinator master(options({"camera"}));
  auto camera = node("camera");
  camera.node.schedule = {.period = 0};
  EXPECT_TRUE(master.join(camera));
}

}  // namespace
}  // namespace dmise
