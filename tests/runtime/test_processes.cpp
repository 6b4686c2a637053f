// A whole network of processes: what happens when one of them dies, hangs, is doubled or is
// missing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "core/base/files/text_file.h"
#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/master_link/master_link.h"
#include "nodes/runtime/observability/status.h"
#include "nodes/runtime/transport/socket.h"
#include "tests/runtime/until_lost.h"
#include "tests/support/process.h"
#include "tests/support/report.h"

namespace dmise {
namespace {

using test::Child;
using test::digest_in;
using test::wait_until_lost;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string bin = DMISE_BINARY_DIR "/bin/";

/// Master, broker, orbit, cameras a and b, recorder; each its own process.
struct Stack {
  std::unique_ptr<Child> master;
  std::string address;
  std::map<std::string, std::unique_ptr<Child>> nodes;

  explicit Stack(const std::vector<std::string>& master_flags) {
    std::vector<std::string> command{bin + "dmise-time-master", "--expect", "orbit,a,b,recorder",
                                     "--announce-fd", "1"};
    command.insert(command.end(), master_flags.begin(), master_flags.end());
    master = std::make_unique<Child>(command);
    if (!master->says("\n")) return;
    address = master->output().substr(0, master->output().find('\n'));
  }
  void start_broker() {
    nodes["broker"] = std::make_unique<Child>(
        std::vector<std::string>{bin + "dmise-broker", "--master", address});
  }
  Child& start(const std::string& name, std::vector<std::string> more = {}) {
    const std::string role = name == "a" || name == "b" ? "camera" : name;
    std::vector<std::string> command{bin + "toy-node", "--role", role, "--name", name,
                                     "--master",       address};
    command.insert(command.end(), more.begin(), more.end());
    nodes[name] = std::make_unique<Child>(command);
    return *nodes[name];
  }
  void start_all() {
    start_broker();
    for (const char* name : {"recorder", "b", "a", "orbit"}) start(name);
  }
  /// Every process but `except` has ended within the time and with this code.
  void expect_all_exit(int code, const std::string& except = "", double within_s = 120) {
    EXPECT_EQ(master->exit_code(within_s), code) << master->output();
    for (auto& [name, node] : nodes)
      if (name != except) {
        EXPECT_EQ(node->exit_code(within_s), code) << name << ": " << node->output();
      }
  }
};

TEST(Processes, RunToTheEndAndReportIt) {
  const std::string report = testing::TempDir() + "dmise-report.json";
  Stack stack({"--ticks", "20", "--window", "3", "--report", report});
  stack.start_all();
  stack.expect_all_exit(0);
  const std::string json = read_text_file(report);
  EXPECT_THAT(json, HasSubstr(R"({"status":"ended","cause":"","granted_tick":19,)"));
  EXPECT_THAT(json, HasSubstr(R"("recorder":{"compute_s":)"));
}

// The promise: a dead node is named within `silent_after_s`.
TEST(Processes, AKilledNodeIsNamedAndTheRunFails) {
  for (const std::string victim : {"orbit", "a", "recorder", "broker"}) {
    Stack stack({"--ticks", "100000000", "--silent-after", "5"});
    stack.start_all();
    ASSERT_TRUE(stack.nodes["b"]->says("step 5\n")) << stack.nodes["b"]->output();
    stack.nodes[victim]->kill(SIGKILL);
    EXPECT_TRUE(stack.master->says(victim + " has closed its connection", 5.0))
        << stack.master->output();
    stack.expect_all_exit(1, victim);
    for (auto& [name, node] : stack.nodes)
      if (name != victim) {
        EXPECT_THAT(node->output(), HasSubstr(victim + " has"));
      }
  }
}

TEST(Processes, AStoppedNodeIsNamedAndTheRunFails) {
  Stack stack({"--ticks", "100000000", "--silent-after", "2"});
  stack.start_all();
  ASSERT_TRUE(stack.nodes["b"]->says("step 5\n"));
  stack.nodes["a"]->kill(SIGSTOP);
  EXPECT_TRUE(stack.master->says("a has been silent for ", 4.0)) << stack.master->output();
  stack.expect_all_exit(1, "a");
}

TEST(Processes, AMasterThatWasStoppedForTooLongBlamesItself) {
  Stack stack({"--ticks", "100000000", "--silent-after", "1", "--on-silent", "wait"});
  stack.start_all();
  ASSERT_TRUE(stack.nodes["b"]->says("step 5\n"));
  stack.master->kill(SIGSTOP);
  for (const char* name : {"orbit", "a", "b", "recorder", "broker"})
    EXPECT_EQ(stack.nodes[name]->exit_code(), 1) << name;
  stack.master->kill(SIGCONT);
  EXPECT_EQ(stack.master->exit_code(), 1);
  EXPECT_THAT(stack.master->output(), HasSubstr("error: time-master was stopped for "));
}

TEST(Processes, TheRunGoesOnWithoutAKilledNodeByPolicy) {
  Stack stack({"--ticks", "5000", "--silent-after", "2", "--on-silent", "drop"});
  stack.start_all();
  ASSERT_TRUE(stack.nodes["b"]->says("step 5\n"));
  stack.nodes["a"]->kill(SIGKILL);
  stack.expect_all_exit(0, "a");
  EXPECT_THAT(stack.nodes["recorder"]->output(), HasSubstr("step 4999\n"));
}

TEST(Processes, WhoCannotDoWithoutALostNodeIsLostWithIt) {
  Stack stack({"--ticks", "5000", "--silent-after", "5", "--on-silent", "drop"});
  stack.start_all();
  ASSERT_TRUE(stack.nodes["b"]->says("step 5\n"));
  stack.nodes["orbit"]->kill(SIGKILL);
  EXPECT_TRUE(stack.nodes["recorder"]->says("step 4999\n", 60));  // it can
  EXPECT_EQ(stack.master->exit_code(), 0);
  EXPECT_THAT(stack.master->output(), HasSubstr("orbit is lost: the run goes on without it"));
  for (const char* name : {"a", "b"}) {
    EXPECT_EQ(stack.nodes[name]->exit_code(), 1);
    EXPECT_THAT(stack.nodes[name]->output(),
                HasSubstr("nothing is published on state/objects from tick "));
  }
}

TEST(Processes, ANodeThatDiesBeforeTheStartIsNamed) {
  Stack stack({"--ticks", "10"});
  stack.start("orbit");
  ASSERT_TRUE(stack.master->says("orbit joined"));
  stack.nodes["orbit"]->kill(SIGKILL);
  EXPECT_TRUE(stack.master->says("orbit is lost: waiting for another process of its name"));
}

TEST(Processes, TheRunWaitsForAStoppedNodeByPolicy) {
  Stack stack({"--ticks", "2000", "--silent-after", "2", "--on-silent", "wait"});
  stack.start_all();
  ASSERT_TRUE(stack.nodes["b"]->says("step 5\n"));
  stack.nodes["a"]->kill(SIGSTOP);
  wait_until_lost(stack.address, "a");
  EXPECT_THAT(ask_master(stack.address, 60).holding, ElementsAre("a"));
  stack.nodes["a"]->kill(SIGCONT);
  stack.expect_all_exit(0, "");
}

TEST(Processes, ARestartedNodeLeavesTheRunAsItWas) {
  const std::string report = testing::TempDir() + "dmise-restart-report.json";
  const std::vector<std::string> flags{"--ticks",     "6000", "--window",        "3",
                                       "--on-silent", "wait", "--rejoin-within", "120",
                                       "--report",    report, "--silent-after",  "30"};
  std::string undisturbed;
  {
    Stack stack(flags);
    stack.start_all();
    stack.expect_all_exit(0, "", 120);
    undisturbed = digest_in(report);
  }
  Stack stack(flags);
  stack.start_all();
  int at = 100;
  for (const std::string victim : {"a", "orbit", "broker", "recorder"}) {
    ASSERT_TRUE(stack.nodes["b"]->says("step " + std::to_string(at) + "\n"));
    at += 400;
    stack.nodes[victim]->kill(SIGKILL);
    wait_until_lost(stack.address, victim);
    victim == "broker" ? stack.start_broker() : static_cast<void>(stack.start(victim));
  }
  stack.expect_all_exit(0, "", 120);
  EXPECT_EQ(digest_in(report), undisturbed);
  EXPECT_EQ(undisturbed.size(), 16u);
  EXPECT_THAT(read_text_file(report),
              HasSubstr(R"("restarts":{"a":1,"broker":1,"orbit":1,"recorder":1})"));
}

/// Listens where others expect a socket of another kind, until one of them has come.
void be_a_stranger_at(const std::string& address) {
  zmq::context_t context(1);
  zmq::socket_t stranger = make_socket(context, zmq::socket_type::router, max_control_bytes);
  zmq::socket_t events = make_socket(context, zmq::socket_type::pair, max_control_bytes);
  zmq_socket_monitor(stranger.handle(), "inproc://stranger",
                     ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL | ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL |
                         ZMQ_EVENT_DISCONNECTED);
  events.connect("inproc://stranger");
  stranger.bind(address);
  std::vector<zmq::pollitem_t> items{{events.handle(), 0, ZMQ_POLLIN, 0}};
  wait_for(items, std::chrono::seconds(60));
  EXPECT_TRUE(items[0].revents) << address;
}

TEST(Processes, ABrokerReturnsToWhereAStrangerHasBeen) {
  Stack stack({"--ticks", "100000000", "--on-silent", "wait"});
  stack.start_all();
  ASSERT_TRUE(stack.nodes["b"]->says("step 5\n"));
  const BrokerEndpoints earlier = ask_master(stack.address, 60).broker;
  stack.nodes["broker"]->kill(SIGKILL);
  wait_until_lost(stack.address, "broker");
  be_a_stranger_at(earlier.subscribe);
  be_a_stranger_at(earlier.publish);
  stack.start_broker();
  // Who does not find it goes on by asking for every tick, a hundred times slower.
  const Tick later = ask_master(stack.address, 60).granted + 5'000;
  EXPECT_TRUE(stack.nodes["recorder"]->says("step " + std::to_string(later) + "\n", 60));
}

TEST(Processes, AHungStepIsNamedByItsProgressDeadline) {
  Stack stack({"--ticks", "100", "--progress-after", "1"});
  stack.start_broker();
  for (const char* name : {"recorder", "b", "orbit"}) stack.start(name);
  stack.start("a", {"--hang-at", "7"});
  EXPECT_TRUE(stack.master->says("a has made no progress for ")) << stack.master->output();
  stack.expect_all_exit(1);  // the hung one too: its process ends itself
}

TEST(Processes, AHungStepIsNamedAfterAQuarterOfAnHourUnlessItIsSaidOtherwise) {
  const Stack stack({"--ticks", "10"});
  zmq::context_t context(1);
  MasterLink link(context, stack.address, nullptr);
  v1::Join join;
  join.set_name("orbit");
  EXPECT_EQ(link.join(join, std::chrono::seconds(60)).progress_after_s(), 900.0);
}

TEST(Processes, TheMasterSaysWhoIsMissing) {
  Stack stack({"--ticks", "10", "--start-within", "1"});
  stack.start_broker();
  stack.start("orbit");
  EXPECT_TRUE(stack.master->says("not started within 1.0 s: waiting for a, b, recorder"))
      << stack.master->output();
  stack.expect_all_exit(1);
}

TEST(Processes, ASecondNodeOfOneNameIsToldSo) {
  Stack stack({"--ticks", "10"});
  stack.start("orbit");
  ASSERT_TRUE(stack.master->says("orbit joined"));
  Child twin({bin + "toy-node", "--role", "orbit", "--name", "orbit", "--master", stack.address});
  EXPECT_EQ(twin.exit_code(), 1);
  EXPECT_THAT(twin.output(), HasSubstr("a node named orbit has already joined"));
}

TEST(Processes, APortInUseIsOneClearLine) {
  Stack stack({"--ticks", "10"});
  Child second({bin + "dmise-time-master", "--expect", "orbit", "--bind", stack.address});
  EXPECT_EQ(second.exit_code(), 1);
  EXPECT_THAT(second.output(), HasSubstr(stack.address + ": address already in use\n"));
}

TEST(Processes, WrongOptionsExitWithTwo) {
  for (const std::vector<std::string>& flags : {std::vector<std::string>{"--expect", "a,a"},
                                                {"--expect", "a", "--ticks", "0"},
                                                {"--expect", "a", "--on-silent", "perhaps"},
                                                {"--expct", "a"},
                                                {}}) {
    std::vector<std::string> command{bin + "dmise-time-master"};
    command.insert(command.end(), flags.begin(), flags.end());
    Child master(command);
    EXPECT_EQ(master.exit_code(), 2) << master.output();
  }
  EXPECT_EQ(Child({bin + "dmise-broker"}).exit_code(), 2);
}

TEST(Processes, AnInterruptEndsEverybodyWithinTwoSeconds) {
  Stack stack({"--ticks", "100000000"});
  stack.start_broker();
  for (const char* name : {"recorder", "b", "orbit"}) stack.start(name);
  Child& hung = stack.start("a", {"--hang-at", "7"});
  ASSERT_TRUE(hung.says("step 7\n"));
  stack.master->kill(SIGINT);  // as from a terminal: everybody gets it
  for (auto& [name, node] : stack.nodes) node->kill(SIGINT);
  const auto start = std::chrono::steady_clock::now();
  stack.expect_all_exit(1, "", 5);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(2000));
}

// docs/wire.md and proto/ are enough: this node shares no code with the others.
TEST(Processes, APythonNodeTakesPartInTheClock) {
  setenv("PYTHONPATH", DMISE_PROTO_PYTHON, 1);
  Stack stack({"--ticks", "20", "--window", "2"});
  stack.start_broker();
  for (const char* name : {"b", "a", "orbit"}) stack.start(name);
  const std::string node = DMISE_SOURCE_DIR "/clients/python/node.py";
  stack.nodes["recorder"] = std::make_unique<Child>(std::vector<std::string>{
      "/usr/bin/python3", node, stack.address, "recorder", "detection/a", "detection/b"});
  stack.expect_all_exit(0);
  // A toy camera has (tick % 3) sets of (tick % 5) detections; there are two cameras.
  EXPECT_THAT(stack.nodes["recorder"]->output(), HasSubstr("tick 14 16 detections\n"));
  EXPECT_THAT(stack.nodes["recorder"]->output(), HasSubstr("tick 19 8 detections\n"));
}

TEST(Processes, APythonSubscriberHearsDetectionsWithoutJoining) {
  setenv("PYTHONPATH", DMISE_PROTO_PYTHON, 1);
  Stack stack({"--ticks", "100000000"});
  Child subscriber(
      {"/usr/bin/python3", DMISE_SOURCE_DIR "/clients/python/subscriber.py", stack.address});
  stack.start_all();
  EXPECT_TRUE(subscriber.says("\na/")) << subscriber.output() << stack.master->output();
}

TEST(Processes, NobodySurvivesTheMaster) {
  Stack stack({"--ticks", "100000000", "--silent-after", "1"});
  stack.start_all();
  ASSERT_TRUE(stack.nodes["b"]->says("step 5\n"));
  stack.master->kill(SIGKILL);
  for (auto& [name, node] : stack.nodes) {
    EXPECT_EQ(node->exit_code(), 1) << name;
    EXPECT_THAT(node->output(), HasSubstr("has been silent for 1."));
  }
}

}  // namespace
}  // namespace dmise
