// The nodes of a host as one member of the run: what their agent may say, and when.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nodes/agent/host_barrier.h"

namespace dmise {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;
using What = HostBarrier::News::What;

constexpr Tick far = 1000;  // granted

TickTally tally(const std::string& node, Tick tick, std::uint64_t digest = 7) {
  return {tick, {{"detection/" + node, 1, std::uint64_t(tick + 1), digest}}};
}

/// a and b, from tick 0 on.
struct Host {
  explicit Host(PulseLimits limits = {}) : barrier(limits) {
    barrier.join("a", {}, 1, 0, seconds(0));
    barrier.join("b", {}, 1, 0, seconds(0));
  }
  void done(const std::string& node, Tick tick, std::uint64_t digest = 7) {
    barrier.done(node, tally(node, tick, digest), seconds(0));
  }
  /// Ticks that are told now.
  std::vector<Tick> told(Tick granted = far) {
    std::vector<Tick> ticks;
    while (const auto t = barrier.take_done(granted)) ticks.push_back(t->tick);
    return ticks;
  }
  HostBarrier barrier;
};

TEST(HostBarrier, TellsATickOnceAllHaveDoneIt) {
  Host host;
  host.done("a", 0);
  EXPECT_THAT(host.told(), IsEmpty());
  host.done("b", 0);
  EXPECT_THAT(host.told(), ElementsAre(0));
  EXPECT_THAT(host.told(), IsEmpty());
}

TEST(HostBarrier, GivesUpAProcessWhoseConnectionBrokeWhenAnotherAsksForItsName) {
  Host host;
  host.barrier.give_up("a");
  EXPECT_THAT(host.barrier.take_news(), IsEmpty());
  host.barrier.suspect("a", seconds(1));
  host.barrier.give_up("a");
  const auto news = host.barrier.take_news();
  ASSERT_EQ(news.size(), 1u);
  EXPECT_EQ(news[0].what, What::lost);
  EXPECT_EQ(news[0].name, "a");
  EXPECT_FALSE(host.barrier.has_live_process("a"));
}

TEST(HostBarrier, RepeatsItsNewsOnceTheMasterKnowsItAgain) {
  Host host;
  host.barrier.leave("b", false);
  host.barrier.take_news();
  host.barrier.repeat_news();
  const auto news = host.barrier.take_news();
  ASSERT_EQ(news.size(), 2u);
  EXPECT_EQ(news[0].what, What::found);
  EXPECT_EQ(news[1].what, What::lost);
}

TEST(HostBarrier, TellsEveryTickInTurnWhateverTheOrderOfItsNodes) {
  Host host;
  for (Tick tick = 0; tick < 3; ++tick) host.done("a", tick);
  for (Tick tick = 0; tick < 5; ++tick) host.done("b", tick);
  EXPECT_THAT(host.told(), ElementsAre(0, 1, 2));
}

TEST(HostBarrier, AddsUpWhatItsNodesHavePublished) {
  Host host;
  host.done("b", 0, 5);
  host.done("a", 0, 4);
  const auto all = host.barrier.take_done(far);
  ASSERT_TRUE(all);
  ASSERT_EQ(all->topics.size(), 2u);
  EXPECT_EQ(all->topics[0].topic, "detection/a");
  EXPECT_EQ(all->topics[1].topic, "detection/b");
  EXPECT_EQ(all->topics[1].incarnation, 1u);
  EXPECT_EQ(all->digest,
            content_digest("a", tally("a", 0, 4)) + content_digest("b", tally("b", 0, 5)));
}

// A node that works every fourth tick has nothing to say of those between.
TEST(HostBarrier, DoesNotWaitForANodeBetweenItsTicks) {
  HostBarrier barrier({});
  barrier.join("a", {}, 1, 0, seconds(0));
  barrier.join("rare", {.period = 4, .offset = 2}, 1, 0, seconds(0));
  for (Tick tick = 0; tick < 4; ++tick) barrier.done("a", tally("a", tick), seconds(0));
  EXPECT_EQ(barrier.take_done(far)->tick, 0);
  EXPECT_EQ(barrier.take_done(far)->tick, 1);
  EXPECT_FALSE(barrier.take_done(far));
  barrier.done("rare", tally("rare", 2), seconds(0));
  EXPECT_EQ(barrier.take_done(far)->topics.size(), 2u);
  EXPECT_EQ(barrier.take_done(far)->topics.size(), 1u);
}

TEST(HostBarrier, TellsNothingBeyondTheGrant) {
  HostBarrier barrier({});
  barrier.join("rare", {.period = 10, .offset = 5}, 1, 0, seconds(0));
  EXPECT_EQ(barrier.take_done(0)->tick, 0);
  EXPECT_FALSE(barrier.take_done(0));
}

TEST(HostBarrier, NamesWhomTheOthersWaitFor) {
  Host host;
  host.done("a", 0);
  EXPECT_THAT(host.barrier.holding(), ElementsAre("b"));
  host.done("b", 0);
  EXPECT_THAT(host.barrier.holding(), ElementsAre("a", "b"));
}

TEST(HostBarrier, NamesASilentNodeOnceAndItsReturn) {
  Host host({.silent_after = seconds(5)});
  host.barrier.heartbeat("a", false, 0, seconds(5));
  host.barrier.check(seconds(6));
  const auto lost = host.barrier.take_news();
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_EQ(lost[0].what, What::lost);
  EXPECT_EQ(lost[0].name, "b");
  EXPECT_EQ(lost[0].reason, "has been silent for 6.0 s");
  host.barrier.check(seconds(7));
  EXPECT_THAT(host.barrier.take_news(), IsEmpty());
  EXPECT_THAT(host.barrier.holding(), ElementsAre("b"));
  host.barrier.heartbeat("b", false, 0, seconds(8));
  const auto found = host.barrier.take_news();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].what, What::found);
}

TEST(HostBarrier, NamesANodeWhoseConnectionBroke) {
  Host host;
  host.barrier.suspect("a", seconds(1));
  host.barrier.check(seconds(1) + milliseconds(700));
  EXPECT_THAT(host.barrier.take_news(), IsEmpty());
  host.barrier.check(seconds(1) + milliseconds(800));
  ASSERT_EQ(host.barrier.take_news().size(), 1u);
}

TEST(HostBarrier, NamesAStepWithoutProgress) {
  Host host({.silent_after = seconds(100), .progress_after = seconds(2)});
  for (int s = 0; s <= 3; ++s) host.barrier.heartbeat("a", true, 1, seconds(s));
  host.barrier.check(seconds(3));
  const auto news = host.barrier.take_news();
  ASSERT_EQ(news.size(), 1u);
  EXPECT_EQ(news[0].reason, "has made no progress for 3.0 s");
}

// What it did may have died with it: the host has done no more than what it does again.
TEST(HostBarrier, AProcessThatFollowsAnotherDoesAgainWhatTheRunMayStillNeed) {
  Host host;
  for (Tick tick = 0; tick < 4; ++tick) host.done("a", tick), host.done("b", tick);
  EXPECT_THAT(host.told(), ElementsAre(0, 1, 2, 3));
  host.barrier.settled(1);
  host.barrier.begin_join("a");
  host.done("b", 4);
  EXPECT_THAT(host.told(), IsEmpty());
  host.barrier.join("a", {}, 2, 2, seconds(1));
  EXPECT_THAT(host.told(), IsEmpty());
  host.done("a", 2);
  const auto again = host.barrier.take_done(far);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->tick, 2);
  EXPECT_EQ(again->digest, content_digest("a", tally("a", 2)) + content_digest("b", tally("b", 2)));
  EXPECT_EQ(again->topics[0].incarnation, 2u);
  host.done("a", 3), host.done("a", 4);
  EXPECT_THAT(host.told(), ElementsAre(3, 4));
  EXPECT_THAT(host.barrier.take_news(), IsEmpty());
}

TEST(HostBarrier, WhatIsDoneAgainMustBeTheSame) {
  Host host;
  host.done("a", 0), host.done("b", 0);
  host.barrier.join("a", {}, 2, 0, seconds(1));
  host.done("a", 0, 8);
  const auto news = host.barrier.take_news();
  ASSERT_EQ(news.size(), 1u);
  EXPECT_EQ(news[0].what, What::failed);
  EXPECT_EQ(news[0].reason, "tick 0, repeated after a restart, differs from the first time");
}

TEST(HostBarrier, ATickOutOfTurnIsAFault) {
  Host host;
  host.done("a", 3);
  const auto news = host.barrier.take_news();
  ASSERT_EQ(news.size(), 1u);
  EXPECT_EQ(news[0].reason, "tick 3 is done, but 0 was next");
}

TEST(HostBarrier, IsReadyWhenAllAre) {
  Host host;
  host.barrier.ready("a", seconds(0));
  EXPECT_FALSE(host.barrier.all_ready());
  host.barrier.ready("b", seconds(0));
  EXPECT_TRUE(host.barrier.all_ready());
  host.barrier.begin_join("c");
  EXPECT_FALSE(host.barrier.all_ready());
}

// Nodes of an agent that follows a lost one join one by one, and the first must not speak for
// those who are not back.
TEST(HostBarrier, TellsNothingBeforeAllWhoBelongToTheHostAreThere) {
  HostBarrier barrier({});
  barrier.expects({"a", "b"});
  EXPECT_THAT(barrier.holding(), ElementsAre("a", "b"));
  barrier.join("a", {}, 2, 10, seconds(0));
  barrier.ready("a", seconds(0));
  barrier.done("a", tally("a", 10), seconds(0));
  EXPECT_FALSE(barrier.take_done(far));
  EXPECT_FALSE(barrier.all_ready());
  EXPECT_THAT(barrier.holding(), ElementsAre("b"));
  barrier.join("b", {}, 2, 10, seconds(0));
  EXPECT_FALSE(barrier.take_done(far));
  barrier.ready("b", seconds(0));
  EXPECT_TRUE(barrier.all_ready());
  barrier.done("b", tally("b", 10), seconds(0));
  const auto all = barrier.take_done(far);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->tick, 10);
  EXPECT_EQ(all->topics.size(), 2u);
}

TEST(HostBarrier, MissesNobodyOnceTheRunIsOver) {
  Host host;
  host.barrier.run_is_over();
  host.barrier.leave("a", false);
  host.barrier.check(seconds(60));
  EXPECT_THAT(host.barrier.take_news(), IsEmpty());
  EXPECT_TRUE(host.barrier.deserted());
}

}  // namespace
}  // namespace dmise
