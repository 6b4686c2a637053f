// The clock of a network of threads: asked to wait, watched, with nodes of different periods.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/transport/socket.h"
#include "tests/runtime/network_threads.h"
#include "tests/runtime/toy.h"

namespace dmise {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double patience_s = 20.0;

/// Asks the master until `holds`; false when it does not within the time.
bool becomes(const std::string& master, const std::function<bool(const RunStatus&)>& holds) {
  const auto deadline =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  while (std::chrono::steady_clock::now() < deadline)
    if (holds(ask_master(master, patience_s))) return true;
  return false;
}

struct Network {
  explicit Network(MasterOptions options)
      : master(std::move(options)), broker(start_broker(master.address)) {}
  void begin() {
    nodes.push_back(start(orbit, master.address));
    nodes.push_back(start(camera, master.address));
  }
  RunStatus ask(ClockAction action, Tick tick = 0, const std::string& reason = "") {
    return control_master(master.address, patience_s, {action, tick, 0.0, reason});
  }
  ToyOrbit orbit;
  ToyCamera camera{"a"};
  MasterThread master;
  std::future<BrokerResult> broker;
  std::vector<std::future<NodeResult>> nodes;
};

TEST(Clock, PausesStepsAndGoesOnOnATickBoundary) {
  Network network(run_of({"orbit", "a"}, 50, 3));
  network.ask(ClockAction::pause, 10);
  network.begin();
  const auto at = [](Tick tick) {
    return [tick](const RunStatus& s) { return s.paused && s.settled == tick; };
  };
  EXPECT_TRUE(becomes(network.master.address, at(10)));
  EXPECT_THAT(ask_master(network.master.address, patience_s).holding, IsEmpty());
  network.ask(ClockAction::step, 2);
  EXPECT_TRUE(becomes(network.master.address, at(12)));
  EXPECT_FALSE(network.ask(ClockAction::go_on).paused);
  EXPECT_EQ(network.master.result.get().exit_code, 0);
}

TEST(Clock, EndsEarlyWithNoTickHalfDone) {
  Network network(run_of({"orbit", "a"}, 50, 3));
  network.ask(ClockAction::pause, 10);
  network.begin();
  EXPECT_TRUE(becomes(network.master.address, [](const auto& s) { return s.settled == 10; }));
  network.ask(ClockAction::end_early, 0, "enough");
  const MasterResult result = network.master.result.get();
  EXPECT_EQ(result.reason, "ended on request: enough");
  EXPECT_EQ(result.exit_code, 1);  // not the whole run
  for (auto& node : network.nodes) {
    const NodeResult end = node.get();
    EXPECT_EQ(end.exit_code, 0) << end.reason;
    EXPECT_EQ(end.done, 10);
  }
}

// At the first pace its last tick would be due after 40 minutes.
TEST(Clock, ChangesItsPace) {
  auto options = run_of({"orbit", "a"}, 5);
  options.run.pace.factor = 2e-3;
  Network network(options);
  network.begin();
  EXPECT_TRUE(becomes(network.master.address, [](const auto& s) { return s.settled == 0; }));
  EXPECT_EQ(ask_master(network.master.address, patience_s).pace, 2e-3);
  EXPECT_EQ(control_master(network.master.address, patience_s, {ClockAction::pace, 0, 1e3}).pace,
            1e3);
  EXPECT_EQ(network.master.result.get().exit_code, 0);
}

TEST(Clock, KeepsRealTime) {
  auto options = run_of({"orbit", "a"}, 5);
  options.run.pace.factor = 100;  // ticks of 1 s: 10 ms each
  Network network(options);
  network.begin();
  const MasterResult result = network.master.result.get();
  EXPECT_EQ(result.exit_code, 0) << result.reason;
  EXPECT_GE(result.wall_s, 0.05);  // tick 5 is not due earlier
}

TEST(Clock, TheDigestOfARunDependsOnWhatIsPublishedAlone) {
  const auto digest_of_run = [](std::size_t objects, int window) {
    Network network(run_of({"orbit", "a"}, 20, window));
    network.orbit = ToyOrbit(objects);
    network.begin();
    return network.master.result.get().digest;
  };
  const auto digest = digest_of_run(20, 1);
  EXPECT_EQ(digest, digest_of_run(20, 4));
  EXPECT_NE(digest, digest_of_run(21, 4));
}

/// Notes the ticks of what it is given.
class Watcher : public Evaluator {
 public:
  std::string name() const override { return "watcher"; }
  std::vector<std::string> produces() const override { return {}; }
  std::vector<std::string> consumes() const override { return {objects_topic}; }
  Tick look_back() const override { return 2; }
  std::vector<Message> resume(Tick, std::span<const Message> past) override {
    for (const Message& m : past) note(m);
    resumed.set_value();
    return {};
  }
  std::vector<Message> step(Tick, std::span<const Message> inputs) override {
    for (const Message& m : inputs) note(m);
    return {};
  }
  void note(const Message& m) {
    rosters += std::holds_alternative<ObjectRoster>(*m.state);
    if (std::holds_alternative<ObjectStates>(*m.state)) ticks.push_back(m.tick);
  }
  int rosters = 0;
  std::vector<Tick> ticks;
  std::promise<void> resumed;
};

TEST(Clock, AnObserverJoinsLateAndHearsTheLastValues) {
  Network network(run_of({"orbit", "a"}, 40, 3));
  network.ask(ClockAction::pause, 20);
  network.begin();
  ASSERT_TRUE(becomes(network.master.address, [](const auto& s) { return s.settled == 20; }));
  Watcher watcher;
  auto watching = std::async(std::launch::async, [&] {
    return run_node(watcher, {.master = network.master.address, .observer = true});
  });
  ASSERT_TRUE(becomes(network.master.address, [](const auto& s) {
    return std::any_of(s.nodes.begin(), s.nodes.end(), [](const auto& n) { return n.observer; });
  }));
  ASSERT_EQ(watcher.resumed.get_future().wait_for(std::chrono::seconds(30)),
            std::future_status::ready);
  network.ask(ClockAction::go_on);
  EXPECT_EQ(network.master.result.get().exit_code, 0);
  const NodeResult result = watching.get();
  EXPECT_EQ(result.exit_code, 0) << result.reason;
  EXPECT_EQ(watcher.rosters, 1);  // said at tick 0, long before
  ASSERT_GE(watcher.ticks.size(), 2u);
  EXPECT_GE(watcher.ticks[0], 18);
  EXPECT_LE(watcher.ticks[0], 19);
  EXPECT_EQ(result.missed, 0u);
}

/// Counts the messages of each step.
class Slow : public Evaluator {
 public:
  std::string name() const override { return "slow"; }
  std::vector<std::string> produces() const override { return {}; }
  std::vector<std::string> consumes() const override { return {objects_topic}; }
  Schedule schedule() const override { return {.period = 5, .offset = 3}; }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override {
    story += std::to_string(tick) + ":" + std::to_string(inputs.size()) + " ";
    return {};
  }
  std::string story;
};

TEST(Clock, ANodeOfALongerPeriodGetsAllThatWasSaidMeanwhile) {
  Slow slow;
  ToyOrbit orbit;
  MasterThread master(run_of({"orbit", "slow"}, 20, 2));
  auto broker = start_broker(master.address);
  auto a = start(orbit, master.address), b = start(slow, master.address);
  EXPECT_EQ(master.result.get().exit_code, 0);
  b.get();
  EXPECT_EQ(slow.story, "3:5 8:5 13:5 18:5 ");  // at first the roster, and ticks 0 to 3
}

/// Says something on `topic` at every `period`-th tick.
class Rare : public Actor {
 public:
  Rare(std::vector<std::string> topics, Tick period)
      : topics_(std::move(topics)), period_(period) {}
  std::string name() const override { return "rare"; }
  std::vector<std::string> produces() const override { return topics_; }
  Schedule schedule_of(const std::string&) const override { return {.period = period_}; }
  std::vector<Message> step(Tick tick, std::span<const Message>) override {
    std::vector<Message> messages;
    if (tick % period_ != 0) return messages;
    for (const std::string& topic : topics_) {
      SiteState site{.tick = tick, .time = sim_seconds(double(tick))};
      site.sensor = topic.substr(std::string(site_prefix).size());
      messages.push_back({topic, tick, std::make_shared<const State>(std::move(site))});
    }
    return messages;
  }

 private:
  std::vector<std::string> topics_;
  Tick period_;
};

/// Writes down at which steps it gets how many messages of its topic.
class Reader : public Evaluator {
 public:
  explicit Reader(std::string name) : name_(std::move(name)) {}
  std::string name() const override { return name_; }
  std::vector<std::string> produces() const override { return {}; }
  std::vector<std::string> consumes() const override { return {site_prefix + name_}; }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override {
    if (!inputs.empty()) story += std::to_string(tick) + ":" + std::to_string(inputs.size()) + " ";
    return {};
  }
  std::string story;

 private:
  std::string name_;
};

std::string tick_endpoint_of(const std::string& master, zmq::context_t& context) {
  zmq::socket_t socket(context, zmq::socket_type::dealer);
  socket.connect(master);
  v1::NodeMessage hello;
  hello.mutable_hello();
  socket.send(to_frame(hello), zmq::send_flags::none);
  zmq::message_t frame;
  v1::MasterMessage answer;
  return socket.recv(frame) && from_frame(frame, &answer) ? answer.endpoints().tick_endpoint() : "";
}

// Ten nodes with a topic each, which says something at every fourth tick. Manifests go to the node
// that consumes the topic, and nothing is missed or asked for again.
TEST(Clock, WhatFewConsumeIsToldToThemAlone) {
  std::vector<std::unique_ptr<Reader>> readers;
  std::vector<std::string> names{"rare"}, topics;
  for (int i = 0; i < 10; ++i) {
    names.push_back("reader-" + std::to_string(i));
    topics.push_back(site_prefix + names.back());
    readers.push_back(std::make_unique<Reader>(names.back()));
  }
  Rare rare(topics, 4);
  MasterThread master(run_of(names, 9, 3));
  zmq::context_t context(1);
  zmq::socket_t clock(context, zmq::socket_type::sub);
  clock.set(zmq::sockopt::subscribe, "");
  auto broker = start_broker(master.address);
  std::vector<std::future<NodeResult>> nodes;
  nodes.push_back(start(rare, master.address));
  clock.connect(tick_endpoint_of(master.address, context));
  for (auto& reader : readers) nodes.push_back(start(*reader, master.address));
  EXPECT_EQ(master.result.get().exit_code, 0);
  for (auto& node : nodes) {
    const NodeResult result = node.get();
    EXPECT_EQ(result.exit_code, 0) << result.reason;
    EXPECT_EQ(result.resend_requests_known, 0u);
  }
  for (const auto& reader : readers) EXPECT_EQ(reader->story, "0:1 4:1 8:1 ");
  int grants = 0;
  for (zmq::message_t frame; clock.recv(frame, zmq::recv_flags::dontwait); ++grants) {
    v1::Grant grant;
    ASSERT_TRUE(from_frame(frame, &grant));
    EXPECT_EQ(grant.published_size(), 0);
  }
  EXPECT_GT(grants, 3);
}

}  // namespace
}  // namespace dmise
