// Nodes behind agents: the clock waits for hosts and still knows each node by its name.
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
using testing::IsEmpty;

Coordinator::Request agent(const std::string& name) {
  auto request = node(name);
  request.agent = true;
  return request;
}

Coordinator::Request behind(const std::string& host, const std::string& name) {
  auto request = node(name, {"detection/" + name}, {"state"});
  request.host = host;
  return request;
}

/// Orbit, and cameras a and b behind the agent "host", window 2.
struct Scene {
  explicit Scene(SilentPolicy policy = SilentPolicy::fail) : master(options_for(policy)) {
    master.join(node("orbit", {"state"}));
    master.join(agent("host"));
    master.join(behind("host", "a"));
    master.join(behind("host", "b"));
    master.ready("orbit");
    master.ready("host");
  }
  static CoordinatorOptions options_for(SilentPolicy policy) {
    auto o = options({"orbit", "a", "b"}, 20, 2);
    o.on_silent = policy;
    return o;
  }
  void orbit_to(Tick last) {
    for (Tick tick = master.members().at("orbit").done + 1; tick <= last; ++tick)
      master.done("orbit", tick);
  }
  Coordinator master;
};

TEST(Hosts, AreComplete) {
  Scene run;
  EXPECT_EQ(run.master.phase(), Phase::running);
  EXPECT_EQ(run.master.granted(), 1);
}

TEST(Hosts, MissTheirNodesByName) {
  Coordinator master(options({"orbit", "a", "b"}));
  master.join(agent("host"));
  master.join(behind("host", "b"));
  EXPECT_THAT(master.missing(), ElementsAre("orbit", "a"));
}

TEST(Hosts, AreWaitedForByTheNamesOfTheirNodes) {
  Scene run;
  run.orbit_to(1);
  EXPECT_THAT(run.master.holding(), ElementsAre("host"));
  run.master.report_behind("host", {"b"}, {{"a", 1}, {"b", 0}});
  EXPECT_THAT(run.master.holding(), ElementsAre("b"));
  EXPECT_EQ(run.master.member_of("a").done, 1);
}

TEST(Hosts, LetTheClockGoOnWithOneWord) {
  Scene run;
  run.orbit_to(1);
  run.master.done("host", 0);
  EXPECT_EQ(run.master.granted(), 2);
  run.master.done("host", 1);
  EXPECT_EQ(run.master.granted(), 3);
}

TEST(Hosts, AddUpToTheDigestOfTheSameNodesWithoutAgents) {
  const auto said = [](const std::string& name) {
    return TickTally{0, {{"detection/" + name, 1, 1, 42}}};
  };
  Coordinator flat(options({"a", "b"}, 0));
  for (const char* name : {"a", "b"}) flat.join(node(name));
  for (const char* name : {"a", "b"}) flat.ready(name);
  for (const char* name : {"a", "b"}) flat.done(name, said(name));
  Coordinator hosted(options({"a", "b"}, 0));
  hosted.join(agent("host"));
  hosted.join({.node = {.name = "a"}, .host = "host"});
  hosted.join({.node = {.name = "b"}, .host = "host"});
  hosted.ready("host");
  hosted.done("host", {0, {}, content_digest("a", said("a")) + content_digest("b", said("b"))});
  EXPECT_EQ(flat.phase(), Phase::ended);
  EXPECT_EQ(hosted.phase(), Phase::ended);
  EXPECT_EQ(hosted.digest(), flat.digest());
}

TEST(Hosts, NameALostNodeAsIfItWereThere) {
  Scene run;
  run.master.lost_behind("a", 1, "has closed its connection", 5);
  EXPECT_EQ(run.master.cause(), "a has closed its connection (last tick done: 5 of 20)");
}

TEST(Hosts, NameTheAgentFirstWhenItDies) {
  Scene run;
  run.master.suspect("host", seconds(1));
  run.master.heartbeat("orbit", false, 0, seconds(2));
  run.master.check(seconds(2));
  EXPECT_EQ(run.master.cause(),
            "host has closed its connection (last tick done: -1 of 20), and with it a, b");
}

TEST(Hosts, PassOnTheReasonOfANodeThatFails) {
  Scene run;
  run.master.fail_behind("b", 1, "no space left");
  EXPECT_EQ(run.master.cause(), "b: no space left");
}

TEST(Hosts, AreRefusedWhereTheLostAreDropped) {
  Coordinator master(Scene::options_for(SilentPolicy::drop));
  EXPECT_THAT(*master.join(agent("host")), HasSubstr("drop"));
}

TEST(Hosts, RefuseStrangersAndTwins) {
  Scene run;
  EXPECT_THAT(*run.master.join(behind("host", "c")), HasSubstr("no node named c"));
  EXPECT_THAT(*run.master.join(behind("host", "a")), HasSubstr("already joined"));
  EXPECT_THAT(*run.master.join(node("a")), HasSubstr("already joined"));
  EXPECT_THAT(*run.master.join(behind("nowhere", "a")), HasSubstr("no agent named nowhere"));
  EXPECT_THAT(*run.master.join(agent("a")), HasSubstr("can't be the name of an agent"));
  EXPECT_THAT(*run.master.join(agent("host")), HasSubstr("already joined"));
}

// The agent has said done of ticks whose messages may have died with one of its nodes.
TEST(Hosts, DoAgainWhatOneOfTheirNodesDoesAgain) {
  Scene run(SilentPolicy::wait);
  run.orbit_to(1);
  run.master.done("host", {0, {}, 10});
  run.master.done("host", {1, {}, 11});
  EXPECT_EQ(run.master.settled(), 1);
  run.master.done("host", {2, {}, 12});
  run.master.lost_behind("a", 1, "has closed its connection", 2);
  EXPECT_THAT(run.master.holding(), ElementsAre("a"));
  const auto topology = run.master.topology_version();
  EXPECT_FALSE(run.master.join(behind("host", "a")));
  EXPECT_GT(run.master.topology_version(), topology);
  EXPECT_EQ(run.master.member_of("a").incarnation, 2u);
  EXPECT_EQ(run.master.member_of("a").resumes_at, 2);
  EXPECT_EQ(run.master.members().at("host").done, 1);
  run.orbit_to(3);
  EXPECT_EQ(run.master.granted(), 3);
  run.master.done("host", {2, {}, 12});
  EXPECT_EQ(run.master.granted(), 4);
  EXPECT_EQ(run.master.phase(), Phase::running);
}

TEST(Hosts, FailTheRunWhenWhatIsDoneAgainDiffers) {
  Scene run(SilentPolicy::wait);
  run.master.done("host", {0, {}, 10});
  run.master.lost_behind("a", 1, "has closed its connection", 0);
  run.master.join(behind("host", "a"));
  run.master.done("host", {0, {}, 99});
  EXPECT_THAT(run.master.cause(), HasSubstr("differs from the first time"));
}

TEST(Hosts, WordsOfAnEarlierProcessDoNotCount) {
  Scene run(SilentPolicy::wait);
  run.master.lost_behind("a", 1, "has closed its connection", 0);
  run.master.join(behind("host", "a"));
  run.master.lost_behind("a", 1, "has closed its connection", 0);
  EXPECT_FALSE(run.master.member_of("a").silent);
}

TEST(Hosts, ANodeHeardAgainGoesOn) {
  Scene run(SilentPolicy::wait);
  run.master.lost_behind("a", 1, "has been silent for 5.0 s", 0);
  EXPECT_THAT(run.master.holding(), ElementsAre("a"));
  run.master.found_behind("a", 1);
  EXPECT_FALSE(run.master.member_of("a").silent);
  EXPECT_TRUE(run.master.join(behind("host", "a")));  // it lives: a twin is refused
}

TEST(Hosts, ANewAgentBringsItsNodesBackOneByOne) {
  Scene run(SilentPolicy::wait);
  run.orbit_to(1);
  run.master.done("host", {0, {}, 10});
  run.master.suspect("host", seconds(1));
  run.master.heartbeat("orbit", false, 0, seconds(2));
  run.master.check(seconds(2));
  EXPECT_THAT(run.master.holding(), ElementsAre("host"));
  EXPECT_FALSE(run.master.join(agent("host"), seconds(3)));
  EXPECT_THAT(run.master.holding(), ElementsAre("a", "b"));
  EXPECT_FALSE(run.master.join(behind("host", "a"), seconds(3)));
  EXPECT_FALSE(run.master.join(behind("host", "b"), seconds(3)));
  EXPECT_EQ(run.master.member_of("b").resumes_at, 1);
  run.master.done("host", {1, {}, 11});
  EXPECT_EQ(run.master.settled(), 1);
}

TEST(Hosts, ALostNodeHasItsTimeToComeBack) {
  auto o = Scene::options_for(SilentPolicy::wait);
  o.rejoin_within = seconds(10);
  Coordinator master(o);
  master.join(node("orbit", {"state"}));
  master.join(agent("host"));
  for (const char* name : {"a", "b"}) master.join(behind("host", name));
  master.ready("orbit"), master.ready("host");
  master.lost_behind("a", 1, "has closed its connection", 3, seconds(1));
  for (const char* name : {"orbit", "host"}) master.heartbeat(name, false, 0, seconds(12));
  master.check(seconds(12));
  EXPECT_EQ(master.cause(), "a has not come back within 10.0 s (last tick done: 3 of 20)");
}

/// Orbit alone, with an agent that has no nodes.
Coordinator with_hollow_agent() {
  Coordinator master(options({"orbit"}, 20, 2));
  EXPECT_FALSE(master.join(agent("hollow")));
  EXPECT_FALSE(master.join(node("orbit")));
  master.ready("orbit");
  return master;
}

TEST(AgentWithoutNodes, DoesNotHoldTheClock) {
  Coordinator master = with_hollow_agent();
  for (Tick tick = 0; tick <= 20; ++tick) {
    EXPECT_EQ(master.granted(), std::min<Tick>(tick + 1, 20));
    master.done("orbit", tick);
  }
  EXPECT_EQ(master.phase(), Phase::ended);
}

TEST(AgentWithoutNodes, MaySayWhatItWillOrBeLost) {
  for (int what = 0; what < 4; ++what) {
    Coordinator master = with_hollow_agent();
    if (what == 0) master.done("hollow", 17);
    if (what == 1) master.fail("hollow", "a reason");
    if (what == 2) master.leave("hollow", true);
    if (what == 3) {
      master.heartbeat("orbit", false, 0, seconds(9));
      master.check(seconds(9));
      EXPECT_FALSE(master.members().contains("hollow"));
    }
    master.done("orbit", 0, seconds(9));
    EXPECT_EQ(master.granted(), 2) << what;
    EXPECT_EQ(master.phase(), Phase::running) << what;
  }
}

TEST(AgentWithoutNodes, IsOneOfABoundedNumber) {
  Coordinator master(options({"orbit", "a"}));
  EXPECT_FALSE(master.join(agent("host-1")));
  EXPECT_FALSE(master.join(agent("host-2")));
  EXPECT_EQ(*master.join(agent("host-3")), "as many agents have joined as there are nodes");
}

}  // namespace
}  // namespace dmise
