// Strangers who talk to the time-master of a run under way: it goes on, and nothing of them stays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/transport/socket.h"
#include "tests/runtime/network_threads.h"
#include "tests/runtime/raw_peer.h"
#include "tests/runtime/toy.h"

namespace dmise {
namespace {

using namespace test;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr double patience_s = 20.0;

/// A run that is paused at tick 3, and a stranger with a connection to its time-master.
struct PausedRun {
  PausedRun() : master(run_of({"orbit", "a"}, 20, 3)), broker(start_broker(master.address)) {
    stranger = make_socket(context, zmq::socket_type::dealer, max_control_bytes);
    connect_to(stranger, master.address);
    control_master(master.address, patience_s, {ClockAction::pause, 3});
    nodes.push_back(start(orbit, master.address));
    nodes.push_back(start(camera, master.address));
    const auto deadline = now() + seconds(20);
    while (status().settled < 3 && now() < deadline) {
    }
  }
  RunStatus status() const { return ask_master(master.address, patience_s); }
  void say(const v1::NodeMessage& message) {
    stranger.send(to_frame(message), zmq::send_flags::none);
  }
  /// The next answer to the stranger, if one comes within the time.
  std::optional<v1::MasterMessage> answer(std::chrono::nanoseconds within = seconds(20)) {
    std::vector<zmq::pollitem_t> items{{stranger.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, within);
    const auto frame = receive_one(stranger);
    v1::MasterMessage message;
    if (!frame || !from_frame(*frame, &message)) return std::nullopt;
    return message;
  }
  v1::NodeMessage join(const std::string& name, bool observer) const {
    v1::NodeMessage message;
    message.mutable_join()->set_name(name);
    message.mutable_join()->set_observer(observer);
    return message;
  }
  /// The run goes on and ends as if nothing had been.
  void expect_a_good_end() {
    control_master(master.address, patience_s, {ClockAction::go_on});
    const MasterResult result = master.result.get();
    EXPECT_EQ(result.exit_code, 0) << result.reason;
    for (auto& node : nodes) EXPECT_EQ(node.get().exit_code, 0);
  }
  ToyOrbit orbit;
  ToyCamera camera{"a"};
  MasterThread master;
  std::future<BrokerResult> broker;
  std::vector<std::future<NodeResult>> nodes;
  zmq::context_t context{1};
  zmq::socket_t stranger;
};

// 32 at once, 8 that wait, 100 a second; somebody else is answered meanwhile.
TEST(Strangers, AreAnsweredAtABoundedRate) {
  PausedRun run;
  const auto began = now();
  v1::NodeMessage hello;
  hello.mutable_hello();
  for (int i = 0; i < 100'000; ++i) run.say(hello);
  EXPECT_EQ(run.status().settled, 3);
  double answers = 0;
  while (run.answer(milliseconds(500))) ++answers;
  const double seconds_taken = std::chrono::duration<double>(now() - began).count();
  EXPECT_GE(answers, 32);
  EXPECT_LE(answers, 32 + 8 + 100 * seconds_taken);
  run.expect_a_good_end();
}

TEST(Strangers, AskTheClockOfTheirOwnRunAlone) {
  PausedRun run;
  v1::NodeMessage abort;
  abort.mutable_control()->set_action(v1::Control::ACTION_ABORT);
  for (const std::uint64_t run_id : {std::uint64_t(0), run.status().run_id + 1}) {
    abort.set_run_id(run_id);
    run.say(abort);
    EXPECT_FALSE(run.answer(milliseconds(300)));
  }
  EXPECT_EQ(run.status().phase, Phase::running);
  run.expect_a_good_end();
}

TEST(Strangers, DoNotBeatForOthers) {
  PausedRun run;
  v1::NodeMessage beat;
  beat.set_run_id(run.status().run_id);
  beat.mutable_heartbeat()->set_name("a");
  beat.mutable_heartbeat()->set_incarnation(1);
  beat.mutable_heartbeat()->mutable_times()->set_frames(1'000'000'000);
  for (std::uint64_t token : {0, 1, 2}) {
    beat.mutable_heartbeat()->set_token(token);
    run.say(beat);
  }
  EXPECT_FALSE(run.answer(milliseconds(300)));
  for (const NodeStatus& node : run.status().nodes)
    EXPECT_LT(node.times.frames, 1000u) << node.name;
  run.expect_a_good_end();
}

TEST(Strangers, SayNothingForOthers) {
  PausedRun run;
  const auto id = run.status().run_id;
  for (int kind = 0; kind < 5; ++kind) {
    v1::NodeMessage message;
    message.set_run_id(id);
    if (kind == 0) message.mutable_ready();
    if (kind == 1) message.mutable_done()->set_tick(4);
    if (kind == 2) message.mutable_leave();
    if (kind == 3) message.mutable_failed()->set_reason("a stranger says so");
    if (kind == 4) {
      message.mutable_node_news()->set_what(v1::NodeNews::WHAT_FAILED);
      message.mutable_node_news()->set_name("a");
      message.mutable_node_news()->set_incarnation(1);
    }
    for (int i = 0; i < 1000; ++i) run.say(message);
  }
  EXPECT_EQ(run.status().phase, Phase::running);
  EXPECT_EQ(run.status().settled, 3);
  run.expect_a_good_end();
}

TEST(Strangers, WhoObserveAreForgottenWhenTheyGo) {
  PausedRun run;
  for (int i = 0; i < 100; ++i) {
    auto watcher = make_socket(run.context, zmq::socket_type::dealer, max_control_bytes);
    connect_to(watcher, run.master.address);
    std::swap(watcher, run.stranger);
    run.say(run.join("watcher " + std::to_string(i), true));
    const auto welcome = run.answer();
    ASSERT_TRUE(welcome && welcome->has_welcome()) << i;
    v1::NodeMessage leave;
    leave.set_run_id(welcome->welcome().run_id());
    leave.mutable_leave();
    run.say(leave);
    EXPECT_TRUE(run.answer()->has_topology());
  }
  const auto deadline = now() + seconds(20);
  while (run.status().nodes.size() > 3 && now() < deadline) {
  }
  EXPECT_EQ(run.status().nodes.size(), 3u);  // orbit, a and the broker
  run.expect_a_good_end();
}

TEST(Strangers, HaveOneNameForAConnection) {
  PausedRun run;
  run.say(run.join("watcher", true));
  ASSERT_TRUE(run.answer()->has_welcome());
  run.say(run.join("another", true));
  auto answer = run.answer();
  if (answer && answer->has_topology()) answer = run.answer();
  ASSERT_TRUE(answer && answer->has_refuse());
  EXPECT_EQ(answer->refuse().reason(), "this connection is that of watcher");
  run.expect_a_good_end();
}

TEST(Strangers, WhoObserveAreNotInTheTopology) {
  PausedRun run;
  run.say(run.join("watcher", true));
  ASSERT_TRUE(run.answer()->has_welcome());
  const auto topology = run.answer();
  ASSERT_TRUE(topology && topology->has_topology());
  std::vector<std::string> names;
  for (const auto& publisher : topology->topology().publishers()) names.push_back(publisher.name());
  EXPECT_THAT(names, testing::UnorderedElementsAre("orbit", "a"));
  run.expect_a_good_end();
}

// One message may have a MiB: of many, or of many parts, nothing stays and nobody waits.
TEST(Strangers, MaySendWhatIsTooLong) {
  PausedRun run;
  RawPeer peer(run.master.address, "DEALER");
  const std::string part = RawPeer::frame(std::string(1 << 20, 'x'), true);
  for (int i = 0; i < 200 && peer.say(part); ++i) {
  }
  v1::NodeMessage join = run.join("orbit", false);
  for (int i = 0; i < 400'000; ++i) join.mutable_join()->add_produces();
  for (int i = 0; i < 50; ++i) run.say(join);
  EXPECT_EQ(run.status().settled, 3);
  run.expect_a_good_end();
}

}  // namespace
}  // namespace dmise
