#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/time_master/coordinators.h"

namespace dmise {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;

using namespace test;

TEST(Coordinator, WaitsForTheSlowestNode) {
  Coordinator master = started(options({"orbit", "camera"}));
  EXPECT_EQ(master.granted(), 0);
  master.done("orbit", 0);
  EXPECT_EQ(master.granted(), 0);  // camera is still rendering
  EXPECT_THAT(master.holding(), ElementsAre("camera"));
  master.done("camera", 0);
  EXPECT_EQ(master.granted(), 1);
}

TEST(Coordinator, LetsTheFastestRunAWindowAhead) {
  Coordinator master = started(options({"orbit", "camera"}, 9, 4));
  EXPECT_EQ(master.granted(), 3);
  for (Tick tick = 0; tick <= 3; ++tick) master.done("orbit", tick);
  EXPECT_EQ(master.granted(), 3);
  master.done("camera", 0);
  EXPECT_EQ(master.granted(), 4);
}

TEST(Coordinator, NeverGrantsBeyondTheLastTickAndEndsThere) {
  Coordinator master = started(options({"orbit"}, 2, 10));
  EXPECT_EQ(master.granted(), 2);
  for (Tick tick = 0; tick <= 2; ++tick) master.done("orbit", tick);
  EXPECT_EQ(master.phase(), Phase::ended);
  EXPECT_FALSE(master.deserted());
  master.leave("orbit", false);
  EXPECT_TRUE(master.deserted());
}

TEST(Coordinator, OpensTheGateOnlyWhenAllExpectedAreReady) {
  Coordinator master(options({"broker", "orbit", "camera"}));
  master.join({.node = {"broker", {}, {}}, .keeps_time = false});
  master.join(node("orbit"));
  EXPECT_THAT(master.missing(), ElementsAre("camera"));
  EXPECT_EQ(master.phase(), Phase::gathering);
  master.join(node("camera"));
  EXPECT_EQ(master.phase(), Phase::connecting);
  master.ready("camera");
  EXPECT_THAT(master.holding(), ElementsAre("orbit"));
  EXPECT_EQ(master.granted(), -1);
  master.ready("orbit");
  EXPECT_EQ(master.granted(), 0);
}

TEST(Coordinator, RefusesASecondNodeOfOneName) {
  Coordinator master(options({"orbit", "camera"}));
  EXPECT_FALSE(master.join(node("camera")));
  EXPECT_EQ(*master.join(node("camera")), "a node named camera has already joined");
}

TEST(Coordinator, RefusesANodeThatTheRunDoesNotHave) {
  Coordinator master(options({"orbit", "camera"}));
  EXPECT_EQ(*master.join(node("kamera")),
            "this run has no node named kamera; it has orbit, camera");
}

TEST(Coordinator, FailsWhenATopicHasNoProducer) {
  Coordinator master(options({"camera"}));
  master.join(node("camera", {}, {"state/objects"}));
  EXPECT_EQ(master.phase(), Phase::failed);
  EXPECT_EQ(master.cause(), "camera needs state/objects, which nobody produces");
}

TEST(Coordinator, FailsWhenNodesWouldWaitForEachOther) {
  Coordinator master(options({"a", "b"}));
  master.join(node("a", {"x"}, {"y"}));
  master.join(node("b", {"y"}, {"x"}));
  EXPECT_EQ(master.cause(), "nodes wait for each other within a tick: a -> b -> a");
}

TEST(Coordinator, FailsWhenATopicHasTwoProducers) {
  Coordinator master(options({"a", "b"}));
  master.join(node("a", {"x"}));
  master.join(node("b", {"x"}));
  EXPECT_EQ(master.cause(), "x has two producers: a and b");
}

TEST(Coordinator, NamesASilentNodeWithinTheDeclaredTime) {
  Coordinator master = started(options({"orbit", "camera"}));
  master.done("camera", 0, seconds(1));
  master.heartbeat("orbit", false, 0, seconds(5));
  master.check(seconds(6) - milliseconds(1));
  EXPECT_EQ(master.phase(), Phase::running);
  master.check(seconds(6));  // 5 s after its last word
  EXPECT_EQ(master.phase(), Phase::failed);
  EXPECT_EQ(master.cause(), "camera has been silent for 5.0 s (last tick done: 0 of 9)");
}

// Whatever the moment of its death between two heartbeats, and if `check` is called when it asks to
// be and never otherwise. Where a link is cut no connection breaks.
TEST(Coordinator, NamesADeadNodeAHeartbeatBeforeTheDeclaredTimeIsOver) {
  auto o = options({"camera"});
  o.heartbeat = milliseconds(250);
  for (milliseconds died{0}; died < milliseconds(2000); died += milliseconds(7)) {
    Coordinator master = started(o);
    milliseconds next_beat{0};
    Instant named{0};
    while (master.phase() == Phase::running) {
      ASSERT_TRUE(master.next_check());
      if (next_beat <= died && next_beat <= *master.next_check()) {
        master.heartbeat("camera", true, 0, next_beat);
        next_beat += milliseconds(250);
      } else {
        named = *master.next_check();
        master.check(named);
      }
    }
    EXPECT_GT(named, died + o.silent_after - 3 * o.heartbeat);
    EXPECT_LE(named, died + o.silent_after - o.heartbeat);
  }
}

TEST(Coordinator, BlamesNobodyForTheTimeInWhichItsOwnProcessWasStopped) {
  Coordinator master = started(options({"orbit", "camera"}));
  master.heartbeat("orbit", false, 0, seconds(1));
  master.heartbeat("camera", true, 0, seconds(2));
  master.excuse(seconds(2), seconds(30));
  master.check(seconds(33));
  EXPECT_EQ(master.phase(), Phase::running);
  master.check(seconds(34));
  EXPECT_THAT(master.cause(), HasSubstr("orbit has been silent for 5.0 s"));
}

/// Heartbeats of both each second from `from_s` until the run is over; returns when.
int beat(Coordinator& master, int from_s, bool orbit_computes, bool camera_computes) {
  for (int s = from_s; s < 1000; ++s) {
    master.heartbeat("orbit", orbit_computes, std::uint64_t(s), seconds(s));
    master.heartbeat("camera", camera_computes, std::uint64_t(s), seconds(s));
    master.check(seconds(s));
    if (master.over()) return s;
  }
  return 1000;
}

Coordinator with_limit_of_a_minute(SilentPolicy policy = SilentPolicy::fail) {
  auto o = options({"orbit", "camera"});
  o.stalled_after = seconds(60);
  o.on_silent = policy;
  Coordinator master(o);
  master.join(node("orbit", {"state"}));
  master.join(node("camera", {"image"}, {"state"}));
  for (const char* name : {"orbit", "camera"}) master.ready(name);
  return master;
}

TEST(Coordinator, NamesAPublisherThatLivesAndNeverSaysATick) {
  for (const SilentPolicy policy : {SilentPolicy::fail, SilentPolicy::wait}) {
    Coordinator master = with_limit_of_a_minute(policy);
    const int named_s = beat(master, 1, false, false);
    EXPECT_GE(named_s, 60);
    EXPECT_LE(named_s, 70);
    EXPECT_THAT(master.cause(), HasSubstr("orbit has not begun tick 0 for 6"));
    EXPECT_THAT(master.cause(), HasSubstr("although all its inputs are published"));
  }
}

TEST(Coordinator, NamesAConsumerWhomNothingReaches) {
  Coordinator master = with_limit_of_a_minute();
  master.done("orbit", 0, seconds(10));
  EXPECT_GE(beat(master, 10, false, false), 70);
  EXPECT_THAT(master.cause(), HasSubstr("camera has not begun tick 0 for 6"));
}

TEST(Coordinator, LetsALongStepBe) {
  Coordinator master = with_limit_of_a_minute();
  master.done("orbit", 0, seconds(1));
  EXPECT_EQ(beat(master, 1, false, true), 1000);  // camera computes, orbit waits for the grant
}

TEST(Coordinator, GoesOnWithoutAStalledNodeByPolicy) {
  Coordinator master = with_limit_of_a_minute(SilentPolicy::drop);
  master.done("orbit", 0, seconds(1));
  for (int s = 1; s < 75; ++s) {
    for (const char* name : {"orbit", "camera"}) master.heartbeat(name, false, 0, seconds(s));
    master.check(seconds(s));
  }
  EXPECT_EQ(master.granted(), 1);
  EXPECT_TRUE(master.members().at("camera").dropped);
}

TEST(Coordinator, APauseIsNobodysFault) {
  Coordinator master = with_limit_of_a_minute();
  master.pause();
  for (const char* name : {"orbit", "camera"}) master.done(name, 0, seconds(1));
  EXPECT_EQ(beat(master, 1, false, false), 1000);
}

TEST(Coordinator, NamesANodeSoonerWhenItsConnectionBreaks) {
  Coordinator master = started(options({"orbit", "camera"}));
  master.suspect("camera", seconds(1));
  master.check(seconds(1) + milliseconds(700));
  EXPECT_EQ(master.phase(), Phase::running);
  master.check(seconds(1) + milliseconds(800));
  EXPECT_THAT(master.cause(), HasSubstr("camera has closed its connection"));
}

TEST(Coordinator, ForgetsASuspicionWhenTheNodeIsHeard) {
  Coordinator master = started(options({"orbit", "camera"}));
  master.suspect("camera", seconds(1));
  master.heartbeat("camera", false, 0, seconds(1) + milliseconds(500));
  master.check(seconds(3));
  EXPECT_EQ(master.phase(), Phase::running);
}

TEST(Coordinator, FindsAHungStepBehindALivingHeartbeat) {
  auto o = options({"camera"});
  o.progress_after = seconds(10);
  Coordinator master = started(o);
  for (int s = 1; s <= 30; ++s) {  // progress grows until 15 s
    master.heartbeat("camera", true, std::uint64_t(std::min(s, 15)), seconds(s));
    master.check(seconds(s));
    ASSERT_EQ(master.phase() == Phase::failed, s >= 25) << s;
  }
  EXPECT_EQ(master.cause(), "camera has made no progress for 10.0 s (last tick done: -1 of 9)");
}

TEST(Coordinator, WaitsForASilentNodeByPolicy) {
  auto o = options({"orbit", "camera"});
  o.on_silent = SilentPolicy::wait;
  Coordinator master = started(o);
  master.done("orbit", 0, seconds(8));
  master.check(seconds(9));
  EXPECT_EQ(master.phase(), Phase::running);
  EXPECT_EQ(master.granted(), 0);
  EXPECT_TRUE(master.members().at("camera").silent);
  EXPECT_THAT(master.holding(), ElementsAre("camera"));
  master.done("camera", 0, seconds(100));
  EXPECT_FALSE(master.members().at("camera").silent);
  EXPECT_EQ(master.granted(), 1);
}

TEST(Coordinator, NamesWhoHoldsTheClockAndNotWhoWaitsForThem) {
  Coordinator master(options({"orbit", "camera", "recorder"}));
  master.join(node("orbit", {"state"}));
  master.join(node("camera", {"detection"}, {"state"}));
  master.join(node("recorder", {}, {"detection"}));
  for (const char* name : {"orbit", "camera", "recorder"}) master.ready(name);
  EXPECT_THAT(master.holding(), ElementsAre("orbit"));
  master.done("orbit", 0);
  EXPECT_THAT(master.holding(), ElementsAre("camera"));
  master.done("camera", 0);
  EXPECT_THAT(master.holding(), ElementsAre("recorder"));
}

TEST(Coordinator, GoesOnWithoutASilentNodeByPolicy) {
  auto o = options({"orbit", "camera"});
  o.on_silent = SilentPolicy::drop;
  Coordinator master = started(o);
  master.done("orbit", 0, seconds(8));
  master.check(seconds(9));
  EXPECT_EQ(master.phase(), Phase::running);
  EXPECT_TRUE(master.members().at("camera").dropped);
  EXPECT_EQ(master.granted(), 1);
}

// A node may die between saying that a tick is done and its messages leaving the machine.
TEST(Coordinator, ClosesTheTopicsOfADroppedNodeFromWhereTheSlowestIs) {
  auto o = options({"camera", "recorder"}, 9, 4);
  o.on_silent = SilentPolicy::drop;
  Coordinator master(o);
  master.join(node("camera", {"detection"}));
  master.join(node("recorder", {}, {"detection"}));
  master.ready("camera");
  master.ready("recorder");
  for (Tick tick = 0; tick <= 2; ++tick) master.done("camera", tick);
  master.done("recorder", 0, seconds(8));
  master.check(seconds(9));
  EXPECT_TRUE(master.members().at("camera").dropped);
  EXPECT_EQ(master.members().at("camera").closed_from, 1);
}

TEST(Coordinator, BeginsUnderDropWithoutANodeThatDoesNotJoin) {
  auto o = options({"camera", "recorder"});
  o.on_silent = SilentPolicy::drop;
  o.start_within = seconds(10);
  Coordinator master(o);
  master.join(node("recorder", {}, {"detection"}), seconds(1));
  const auto live_until = [&](int end) {
    for (int s = 1; s <= end; ++s) {
      master.heartbeat("recorder", false, 0, seconds(s));
      master.check(seconds(s));
    }
  };
  live_until(9);
  EXPECT_EQ(master.phase(), Phase::gathering);
  live_until(10);
  EXPECT_EQ(master.phase(), Phase::connecting);
  master.ready("recorder", seconds(10));
  EXPECT_EQ(master.phase(), Phase::running);
  const auto& lost = master.members().at("camera");
  EXPECT_TRUE(lost.dropped);
  EXPECT_THAT(lost.node.produces, ElementsAre("detection"));
  EXPECT_EQ(lost.closed_from, 0);
}

TEST(Coordinator, DropsANodeThatDiesWhileOthersConnect) {
  auto o = options({"camera", "recorder"});
  o.on_silent = SilentPolicy::drop;
  Coordinator master(o);
  master.join(node("camera", {"detection"}));
  master.join(node("recorder", {}, {"detection"}));
  master.ready("recorder", seconds(8));
  master.check(seconds(9));
  EXPECT_EQ(master.phase(), Phase::running);
  EXPECT_TRUE(master.members().at("camera").dropped);
}

TEST(Coordinator, NeverGoesOnWithoutTheBroker) {
  auto o = options({"broker", "camera"});
  o.on_silent = SilentPolicy::drop;
  Coordinator master(o);
  master.join({.node = {"broker", {}, {}}, .keeps_time = false});
  master.join(node("camera"));
  master.ready("camera");
  master.heartbeat("camera", false, 0, seconds(8));
  master.check(seconds(9));
  EXPECT_THAT(master.cause(), HasSubstr("broker has been silent"));
}

TEST(Coordinator, ForgetsANodeThatDiesBeforeAllHaveJoined) {
  Coordinator master(options({"orbit", "camera"}));
  master.join(node("camera"));
  master.check(seconds(6));
  EXPECT_THAT(master.missing(), ElementsAre("orbit", "camera"));
  EXPECT_FALSE(master.join(node("camera"), seconds(7)));
}

TEST(Coordinator, NamesWhoIsMissingWhenTheStartTakesTooLong) {
  auto o = options({"orbit", "camera"});
  o.start_within = seconds(30);
  Coordinator master(o);
  master.join(node("camera"), seconds(29));
  master.check(seconds(31));
  EXPECT_EQ(master.cause(), "not started within 30.0 s: waiting for orbit");
}

TEST(Coordinator, KeepsTheFirstCause) {
  Coordinator master = started(options({"orbit", "camera"}));
  master.fail("camera", "disk full");
  master.fail("orbit", "nobody listens");
  master.fail_run("interrupted");
  EXPECT_EQ(master.cause(), "camera: disk full");
}

TEST(Coordinator, SaysTheNameOfTheNodeThatFailsOnce) {
  Coordinator master = started(options({"orbit", "camera"}));
  master.fail("camera", "camera: disk full");
  EXPECT_EQ(master.cause(), "camera: disk full");
}

TEST(Coordinator, FailsWhenANodeLeavesBeforeTheEnd) {
  Coordinator master = started(options({"orbit", "camera"}));
  master.leave("camera", true);
  EXPECT_EQ(master.cause(), "camera was interrupted (last tick done: -1 of 9)");
}

TEST(Coordinator, SaysWhyANodeGaveUp) {
  Coordinator master = started(options({"orbit", "camera"}));
  master.leave("camera", false, seconds(6), "the time-master has been silent for 5.1 s");
  EXPECT_EQ(master.cause(),
            "camera gave up: the time-master has been silent for 5.1 s (last tick done: -1 of 9)");
}

TEST(Coordinator, DoesNoTickTwiceAndLosesNone) {
  Coordinator master = started(options({"orbit"}, 9, 4));
  master.done("orbit", 0);
  master.done("orbit", 0);
  EXPECT_EQ(master.members().at("orbit").done, 0);
  master.done("orbit", 2);
  EXPECT_EQ(master.cause(), "orbit: tick 2 is done, but 1 was next and 4 the last granted");
}

TEST(Coordinator, RefusesOptionsThatMakeNoSense) {
  EXPECT_THROW(Coordinator(options({"a", "a"})), ConfigError);
  EXPECT_THROW(Coordinator(options({})), ConfigError);
  EXPECT_THROW(Coordinator(options({"a"}, 9, 0)), ConfigError);
}

}  // namespace
}  // namespace dmise
