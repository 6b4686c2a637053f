// A process that follows another under its name, and those who only watch.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/time_master/coordinators.h"

namespace dmise {
namespace {

using namespace test;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;

/// Orbit and camera under `wait`, window 4; the camera looks two ticks back.
struct Scene {
  explicit Scene(CoordinatorOptions o = waiting()) : master(std::move(o)) {
    master.join(orbit());
    master.join(camera());
    master.ready("orbit");
    master.ready("camera");
  }
  static CoordinatorOptions waiting() {
    auto o = options({"orbit", "camera"}, 20, 4);
    o.on_silent = SilentPolicy::wait;
    return o;
  }
  static Coordinator::Request orbit() { return node("orbit", {"state"}); }
  static Coordinator::Request camera() {
    auto request = node("camera", {"detection"}, {"state"});
    request.node.look_back = 2;
    return request;
  }
  const Coordinator::Member& member(const std::string& name) { return master.members().at(name); }
  void done_to(const std::string& name, Tick last) {
    for (Tick tick = member(name).done + 1; tick <= last; ++tick) master.done(name, tick);
  }
  Coordinator master;
};

TickTally tally(Tick tick, std::uint64_t digest, std::uint64_t sequence) {
  return {tick, {{"detection", 1, sequence, digest}}};
}

TEST(Rejoin, RefusesATwinOfALivingNode) {
  Scene run;
  EXPECT_EQ(*run.master.join(Scene::camera()), "a node named camera has already joined");
  EXPECT_EQ(run.member("camera").incarnation, 1u);
}

TEST(Rejoin, IsTheNextIncarnationOfALostNode) {
  Scene run;
  run.master.suspect("camera", seconds(1));
  EXPECT_FALSE(run.master.join(Scene::camera(), seconds(1)));
  EXPECT_EQ(run.member("camera").incarnation, 2u);
  EXPECT_FALSE(run.member("camera").silent);
}

TEST(Rejoin, IsRefusedWhereTheRunFailsInstead) {
  auto o = Scene::waiting();
  o.on_silent = SilentPolicy::fail;
  Scene run(o);
  run.master.suspect("camera", seconds(1));
  EXPECT_TRUE(run.master.join(Scene::camera(), seconds(1)));
}

TEST(Rejoin, TakesUpAfterItsLastTickWhenItIsTheSlowest) {
  Scene run;
  run.done_to("orbit", 3);
  run.done_to("camera", 1);
  run.master.suspect("camera", seconds(1));
  run.master.join(Scene::camera(), seconds(1));
  EXPECT_EQ(run.member("camera").resumes_at, 2);
  EXPECT_EQ(run.master.granted(), 5);  // what was granted stays granted
  run.master.done("camera", 2);
  EXPECT_EQ(run.master.granted(), 6);
}

// Its last messages may have died with it: it does again what the slowest may still wait for.
TEST(Rejoin, DoesAgainWhatNotAllHaveDone) {
  Scene run;
  run.done_to("orbit", 3);
  run.done_to("camera", 1);
  run.master.suspect("orbit", seconds(1));
  run.master.join(Scene::orbit(), seconds(1));
  EXPECT_EQ(run.member("orbit").resumes_at, 2);
  EXPECT_EQ(run.master.publishes_from(run.member("orbit")), 0);  // for the camera's look-back
  EXPECT_EQ(run.master.granted(), 5);
  EXPECT_EQ(run.master.settled(), 1);
}

TEST(Rejoin, MustSayTheSameOfATickDoneAgain) {
  for (const bool same : {true, false}) {
    Scene run;
    run.master.done("camera", tally(0, 0xabc, 1));
    run.master.done("camera", tally(1, 0xdef, 2));
    run.master.suspect("camera", seconds(1));
    run.master.join(Scene::camera(), seconds(1));
    run.master.done("camera", tally(0, 0xabc, 1), seconds(1));
    run.master.done("camera", tally(1, same ? 0xdef : 0xfed, 2), seconds(1));
    EXPECT_EQ(run.master.phase(), same ? Phase::running : Phase::failed);
    if (!same) {
      EXPECT_EQ(run.master.cause(),
                "camera: tick 1, repeated after a restart, differs from the first time");
    }
  }
}

TEST(Rejoin, LeavesTheDigestOfTheRunAsItWas) {
  const auto digest_with_restarts_before = [](std::vector<Tick> restarts) {
    auto o = options({"camera"}, 4, 2);
    o.on_silent = SilentPolicy::wait;
    Coordinator master = started(o);
    for (Tick tick = 0; tick <= 4; ++tick) {
      if (std::count(restarts.begin(), restarts.end(), tick)) {
        master.suspect("camera", seconds(tick));
        master.join(node("camera"), seconds(tick));
      }
      master.done("camera", tally(tick, 100 + std::uint64_t(tick), 1), seconds(tick));
    }
    EXPECT_EQ(master.phase(), Phase::ended);
    return master.digest();
  };
  EXPECT_EQ(digest_with_restarts_before({}), digest_with_restarts_before({1, 3}));
}

TEST(Rejoin, IsRefusedWithOtherTopics) {
  Scene run;
  run.master.suspect("camera", seconds(1));
  EXPECT_THAT(*run.master.join(node("camera", {"detection", "more"}, {"state"}), seconds(1)),
              HasSubstr("other topics"));
  EXPECT_EQ(run.member("camera").incarnation, 1u);
}

TEST(Rejoin, EndsTheRunAfterTooManyRestarts) {
  auto o = Scene::waiting();
  o.max_rejoins = 2;
  Scene run(o);
  for (int death = 1; death <= 2; ++death) {
    run.master.suspect("camera", seconds(death));
    EXPECT_FALSE(run.master.join(Scene::camera(), seconds(death)));
  }
  run.master.suspect("camera", seconds(3));
  EXPECT_TRUE(run.master.join(Scene::camera(), seconds(3)));
  EXPECT_EQ(run.master.cause(), "camera has died 3 times");
}

TEST(Rejoin, EndsTheRunWhenItComesTooLate) {
  auto o = Scene::waiting();
  o.rejoin_within = seconds(10);
  Scene run(o);
  run.master.heartbeat("orbit", false, 0, seconds(6));
  run.master.check(seconds(6));
  EXPECT_TRUE(run.member("camera").silent);
  EXPECT_THAT(run.master.holding(), ElementsAre("camera"));
  run.master.heartbeat("orbit", false, 0, seconds(17));
  run.master.check(seconds(17));
  EXPECT_EQ(run.master.cause(),
            "camera has not come back within 10.0 s (last tick done: -1 of 20)");
}

TEST(Rejoin, OfANodeThatDiesWhileAllConnect) {
  Coordinator master(Scene::waiting());
  master.join(Scene::orbit());
  master.join(Scene::camera());
  master.ready("orbit");
  master.suspect("camera", seconds(1));
  EXPECT_FALSE(master.join(Scene::camera(), seconds(1)));
  EXPECT_EQ(master.phase(), Phase::connecting);
  master.ready("camera", seconds(1));
  EXPECT_EQ(master.phase(), Phase::running);
}

TEST(Rejoin, OfTheBrokerHoldsNoTick) {
  auto o = Scene::waiting();
  o.expected.insert(o.expected.begin(), "broker");
  Coordinator master(o);
  const Coordinator::Request broker{.node = {"broker", {}, {}}, .keeps_time = false};
  master.join(broker);
  master.join(Scene::orbit());
  master.join(Scene::camera());
  master.ready("orbit");
  master.ready("camera");
  const auto version = master.topology_version();
  master.suspect("broker", seconds(1));
  master.check(seconds(2));
  EXPECT_THAT(master.holding(), ElementsAre("broker"));
  EXPECT_FALSE(master.join(broker, seconds(2)));
  EXPECT_EQ(master.phase(), Phase::running);
  EXPECT_GT(master.topology_version(), version);  // all must hear where it is
  master.done("orbit", 0, seconds(2));
  master.done("camera", 0, seconds(2));
  EXPECT_EQ(master.granted(), 4);
}

TEST(Rejoin, AnInterruptedNodeIsWaitedFor) {
  Scene run;
  run.master.leave("camera", true, seconds(1));
  EXPECT_EQ(run.master.phase(), Phase::running);
  EXPECT_THAT(run.master.holding(), ElementsAre("camera"));
  EXPECT_FALSE(run.master.join(Scene::camera(), seconds(2)));
}

TEST(Resume, StartsWhereAnEarlierRunStopped) {
  auto o = options({"orbit", "camera"}, 9, 2);
  o.first_tick = 6;
  Coordinator master(o);
  master.join(Scene::orbit());
  master.join(Scene::camera());
  master.ready("orbit");
  EXPECT_EQ(master.granted(), 5);
  master.ready("camera");
  EXPECT_EQ(master.granted(), 7);
  EXPECT_EQ(master.members().at("camera").resumes_at, 6);
  EXPECT_EQ(master.publishes_from(master.members().at("orbit")), 4);  // the camera looks back
  for (Tick tick = 6; tick <= 9; ++tick) {
    master.done("orbit", tick);
    master.done("camera", tick);
  }
  EXPECT_EQ(master.phase(), Phase::ended);
}

// Orbit must have published so early that the camera can have published so early that the tracker
// finds its 5 ticks.
TEST(History, AddsUpAlongTheGraph) {
  const std::vector<NodeTopics> nodes{
      {.name = "orbit", .produces = {"state"}},
      {.name = "camera", .produces = {"detection"}, .consumes = {"state"}, .look_back = 2},
      {.name = "tracker", .consumes = {"detection"}, .look_back = 5, .schedule = {.period = 4}}};
  const auto history = history_ticks(nodes);
  EXPECT_EQ(history.at("tracker"), 0);
  EXPECT_EQ(history.at("camera"), 8);  // the tracker takes 4 ticks at once
  EXPECT_EQ(history.at("orbit"), 10);
}

TEST(History, OfALoopIsItsDelay) {
  std::vector<NodeTopics> nodes{
      {.name = "orbit", .produces = {"state"}, .consumes = {}},
      {.name = "camera", .produces = {"detection"}, .consumes = {"state", "task"}, .look_back = 2},
      {.name = "fusion", .produces = {"task"}, .consumes = {"detection"}}};
  EXPECT_EQ(topic_fault(nodes),
            "nodes wait for each other within a tick: camera -> fusion -> camera");
  nodes[1].delays["task"] = 3;
  EXPECT_EQ(topic_fault(nodes), std::nullopt);
  const auto history = history_ticks(nodes);
  EXPECT_EQ(history.at("fusion"), 3);
  EXPECT_EQ(history.at("camera"), 3);  // what the fusion does again
  EXPECT_EQ(history.at("orbit"), 5);
}

TEST(Observer, JoinsAndLeavesAtAnyTimeAndHoldsNobody) {
  Scene run;
  auto watcher = node("watcher", {}, {"detection"});
  watcher.observer = true;
  run.done_to("orbit", 3);
  run.done_to("camera", 2);
  EXPECT_FALSE(run.master.join(watcher));
  EXPECT_EQ(run.member("watcher").resumes_at, 3);
  run.done_to("camera", 3);
  EXPECT_EQ(run.master.granted(), 7);
  run.master.done("watcher", 3);
  run.master.done("watcher", 9);  // it may skip what it has missed
  EXPECT_EQ(run.master.phase(), Phase::running);
  run.master.leave("watcher", true);
  EXPECT_EQ(run.master.phase(), Phase::running);
  EXPECT_FALSE(run.master.join(watcher));
  run.master.heartbeat("orbit", false, 0, seconds(9));
  run.master.heartbeat("camera", false, 0, seconds(9));
  run.master.check(seconds(9));  // the watcher is silent
  EXPECT_FALSE(run.master.members().contains("watcher"));
  EXPECT_EQ(run.master.phase(), Phase::running);
}

TEST(Observer, CanTakeNoNodesNameAndPublishesNothing) {
  Scene run;
  auto watcher = Scene::camera();
  watcher.observer = true;
  EXPECT_TRUE(run.master.join(watcher));
  watcher = node("watcher", {"detection"});
  watcher.observer = true;
  EXPECT_EQ(*run.master.join(watcher), "an observer publishes nothing");
}

Coordinator::Request watcher(const std::string& name) {
  auto request = node(name);
  request.observer = true;
  return request;
}

TEST(Observer, IsForgottenWhenItLeavesFailsOrIsLost) {
  Scene run;
  for (const char* name : {"leaves", "fails", "lost"})
    EXPECT_FALSE(run.master.join(watcher(name), seconds(1)));
  run.master.leave("leaves", false, seconds(1));
  run.master.fail("fails", "a reason");
  run.master.heartbeat("orbit", false, 0, seconds(9));
  run.master.heartbeat("camera", false, 0, seconds(9));
  run.master.check(seconds(9));
  EXPECT_EQ(run.master.members().size(), 2u);
  EXPECT_THAT(run.master.take_forgotten(), ElementsAre("leaves", "fails", "lost"));
  EXPECT_THAT(run.master.take_forgotten(), testing::IsEmpty());
  EXPECT_EQ(run.master.phase(), Phase::running);
}

TEST(Observer, IsOneOfABoundedNumber) {
  Scene run;
  for (int i = 0; i < 64; ++i)
    EXPECT_FALSE(run.master.join(watcher("watcher " + std::to_string(i))));
  EXPECT_EQ(*run.master.join(watcher("one more")),
            "64 observers have joined already: another may join when one leaves");
  run.master.leave("watcher 7", false);
  EXPECT_FALSE(run.master.join(watcher("one more")));
}

TEST(Observer, IsNoNewsForTheNodesOfTheRun) {
  Scene run;
  const auto version = run.master.topology_version();
  run.master.join(watcher("watcher"));
  run.master.leave("watcher", false);
  EXPECT_EQ(run.master.topology_version(), version);
}

}  // namespace
}  // namespace dmise
