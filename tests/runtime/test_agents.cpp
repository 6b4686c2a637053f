// Networks whose nodes are behind the agents of two hosts: the same bytes, the same words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "core/base/files/text_file.h"
#include "nodes/agent/host_agent.h"
#include "tests/runtime/network_threads.h"
#include "tests/runtime/toy.h"
#include "tests/runtime/until_lost.h"
#include "tests/support/process.h"
#include "tests/support/report.h"

namespace dmise {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string bin = DMISE_BINARY_DIR "/bin/";

/// An address on this host that nobody else has, and that a second agent may take.
std::string local_address(const std::string& name) {
  static int count = 0;
  return "ipc://@dmise-test-" + std::to_string(getpid()) + "-" + std::to_string(count++) + "-" +
         name;
}

/// An agent in a thread; `address` once its nodes may join.
struct AgentThread {
  AgentThread(const std::string& name, const std::string& master) {
    std::promise<std::string> bound;
    auto address_future = bound.get_future();
    result = std::async(std::launch::async, [&bound, name, master] {
      return run_host_agent({.name = name,
                             .master = master,
                             .on_bound = [&](const std::string& at) { bound.set_value(at); }});
    });
    address = address_future.get();
  }
  std::string address;
  std::future<HostAgentResult> result;
};

TEST(Agents, GiveTheBytesOfOneProcessAndBringEachStateOnce) {
  constexpr Tick last_tick = 100;
  ToyOrbit orbit_here;
  ToyCamera a_here("a"), b_here("b"), c_here("c");
  ToyRecorder recorder_here({"a", "b", "c"});
  drive({&orbit_here, &a_here, &b_here, &c_here, &recorder_here}, last_tick);

  for (const int window : {1, 4}) {
    MasterThread master(run_of({"orbit", "a", "b", "c", "recorder"}, last_tick, window));
    AgentThread east("east", master.address), west("west", master.address);
    ToyOrbit orbit;
    ToyCamera a("a"), b("b"), c("c");
    ToyRecorder recorder({"a", "b", "c"});
    auto broker = start_broker(master.address);
    std::vector<std::future<NodeResult>> nodes;
    nodes.push_back(start(orbit, master.address));
    nodes.push_back(start(recorder, west.address));
    for (ToyCamera* camera : {&a, &b, &c}) nodes.push_back(start(*camera, east.address));
    for (auto& node : nodes) {
      const NodeResult result = node.get();
      EXPECT_EQ(result.exit_code, 0) << result.reason;
      EXPECT_EQ(result.refused, 0u) << result.last_refusal;
      EXPECT_EQ(result.done, last_tick);
    }
    EXPECT_TRUE(recorder.record() == recorder_here.record()) << "window " << window;
    const HostAgentResult agent = east.result.get();
    EXPECT_EQ(agent.exit_code, 0) << agent.reason;
    EXPECT_EQ(west.result.get().exit_code, 0);
    const MasterResult result = master.result.get();
    EXPECT_EQ(result.times.size(), 8u);  // broker and agents too
    // A roster, the states of each tick and the probes before; three times that for three cameras.
    const auto probes = agent.messages_in - (last_tick + 2);
    EXPECT_GE(agent.messages_in, std::uint64_t(last_tick + 2));
    EXPECT_LT(probes, 500u);
  }
}

TEST(Agents, RefuseObserversAndOtherAgents) {
  MasterThread master(run_of({"orbit", "a"}, 3));
  AgentThread agent("host", master.address);
  ToyOrbit orbit;
  const NodeResult observer =
      run_node(orbit, {.master = agent.address, .name = "watcher", .observer = true});
  EXPECT_THAT(observer.reason, HasSubstr("only nodes that keep time join an agent"));
  const HostAgentResult second = run_host_agent({.name = "inner", .master = agent.address});
  EXPECT_THAT(second.reason, HasSubstr("only nodes that keep time join an agent"));
  master.stop.set();
  EXPECT_EQ(agent.result.get().reason, "interrupted");
}

/// Master and broker; a and orbit behind the agent "east", b and recorder behind "west".
struct Hosts {
  std::unique_ptr<Child> master;
  std::string address;
  std::map<std::string, std::string> local{{"east", local_address("east")},
                                           {"west", local_address("west")}};
  std::map<std::string, std::unique_ptr<Child>> processes;

  /// `stops_at`: the clock stops after this tick; -1: it does not.
  explicit Hosts(const std::vector<std::string>& master_flags, bool with_agents = true,
                 Tick stops_at = -1) {
    std::vector<std::string> command{bin + "dmise-time-master", "--expect", "orbit,a,b,recorder",
                                     "--announce-fd", "1"};
    command.insert(command.end(), master_flags.begin(), master_flags.end());
    master = std::make_unique<Child>(command);
    if (!master->says("\n")) return;
    address = master->output().substr(0, master->output().find('\n'));
    if (stops_at >= 0) control_master(address, 60, {ClockAction::pause, stops_at});
    if (!with_agents) local = {{"east", address}, {"west", address}};
    start("broker");
    if (with_agents) start("east"), start("west");
    for (const char* name : {"recorder", "b", "a", "orbit"}) start(name);
  }
  static std::string host_of(const std::string& node) {
    return node == "a" || node == "orbit" ? "east" : "west";
  }
  void start(const std::string& name) {
    std::vector<std::string> command;
    if (name == "broker")
      command = {bin + "dmise-broker", "--master", address};
    else if (local.contains(name))
      command = {
          bin + "dmise-host-agent", "--name", name, "--master", address, "--bind", local[name]};
    else
      command = {bin + "toy-node",
                 "--role",
                 name == "a" || name == "b" ? "camera" : name,
                 "--name",
                 name,
                 "--master",
                 local[host_of(name)]};
    processes[name] = std::make_unique<Child>(command);
  }
  Child& operator[](const std::string& name) { return *processes[name]; }
  void expect_all_exit(int code, const std::string& except = "", double within_s = 60) {
    EXPECT_EQ(master->exit_code(within_s), code) << master->output();
    for (auto& [name, process] : processes)
      if (name != except) {
        EXPECT_EQ(process->exit_code(within_s), code) << name << ": " << process->output();
      }
  }
};

TEST(Agents, LeaveTheDigestOfTheRunAsItIs) {
  const std::string report = testing::TempDir() + "dmise-agents-report.json";
  std::vector<std::string> digests;
  for (const bool with_agents : {false, true}) {
    Hosts run({"--ticks", "50", "--window", "3", "--report", report}, with_agents);
    run.expect_all_exit(0);
    digests.push_back(digest_in(report));
  }
  EXPECT_EQ(digests[0].size(), 16u);
  EXPECT_EQ(digests[0], digests[1]);
}

TEST(Agents, NameAKilledNodeInTheWordsOfTheMaster) {
  for (const std::string victim : {"orbit", "a", "recorder"}) {
    Hosts run({"--ticks", "100000000", "--silent-after", "5"});
    ASSERT_TRUE(run["b"].says("step 5\n", 60)) << run["b"].output();
    run[victim].kill(SIGKILL);
    EXPECT_TRUE(run.master->says(victim + " has", 5.0)) << run.master->output();
    run.expect_all_exit(1, victim);
    for (auto& [name, process] : run.processes)
      if (name != victim) {
        EXPECT_THAT(process->output(), HasSubstr(victim + " has")) << name;
      }
  }
}

TEST(Agents, NameAStoppedNode) {
  Hosts run({"--ticks", "100000000", "--silent-after", "2"});
  ASSERT_TRUE(run["b"].says("step 5\n", 60));
  run["a"].kill(SIGSTOP);
  EXPECT_TRUE(run.master->says("a has been silent for ", 20)) << run.master->output();
  run.expect_all_exit(1, "a");
}

TEST(Agents, AreNamedFirstWhenTheyDie) {
  Hosts run({"--ticks", "100000000", "--silent-after", "5"});
  ASSERT_TRUE(run["b"].says("step 5\n", 60));
  run["east"].kill(SIGKILL);
  EXPECT_TRUE(run.master->says("east has", 5.0)) << run.master->output();
  EXPECT_TRUE(run.master->says("and with it a, orbit")) << run.master->output();
  run.expect_all_exit(1, "east");
}

TEST(Agents, AreRefusedWhereTheRunDropsTheLost) {
  MasterOptions options = run_of({"orbit"}, 3);
  options.run.on_silent = SilentPolicy::drop;
  MasterThread master(options);
  const HostAgentResult agent = run_host_agent({.name = "host", .master = master.address});
  EXPECT_EQ(agent.exit_code, 1);
  EXPECT_THAT(agent.reason, HasSubstr("(drop) can't have agents"));
}

TEST(Agents, ARestartedNodeLeavesTheRunAsItWas) {
  const std::string report = testing::TempDir() + "dmise-agents-restart.json";
  const std::vector<std::string> flags{"--ticks",         "6000", "--window",       "3",
                                       "--on-silent",     "wait", "--silent-after", "60",
                                       "--rejoin-within", "120",  "--report",       report};
  std::string undisturbed;
  {
    Hosts run(flags);
    run.expect_all_exit(0, "", 120);
    undisturbed = digest_in(report);
  }
  Hosts run(flags);
  int at = 100;
  for (const std::string victim : {"a", "orbit", "recorder", "broker"}) {
    ASSERT_TRUE(run["b"].says("step " + std::to_string(at) + "\n", 60));
    at += 400;
    run[victim].kill(SIGKILL);
    wait_until_lost(run.address, victim);
    run.start(victim);
  }
  run.expect_all_exit(0, "", 120);
  EXPECT_EQ(digest_in(report), undisturbed);
  EXPECT_EQ(undisturbed.size(), 16u);
  EXPECT_THAT(read_text_file(report),
              HasSubstr(R"("restarts":{"a":1,"broker":1,"orbit":1,"recorder":1})"));
}

// A new agent knows no nodes: those of the one before end, and others of their names join it.
TEST(Agents, ARestartedAgentLeavesTheRunAsItWas) {
  const std::string report = testing::TempDir() + "dmise-agents-return.json";
  const std::vector<std::string> flags{"--ticks",         "1500", "--window",       "3",
                                       "--on-silent",     "wait", "--silent-after", "60",
                                       "--rejoin-within", "120",  "--report",       report};
  std::string undisturbed;
  {
    Hosts run(flags);
    run.expect_all_exit(0, "", 120);
    undisturbed = digest_in(report);
  }
  // The clock stops of itself some ticks after each loss: no process can end before the last.
  constexpr Tick between = 300, margin = 100;
  Tick stops_at = between;
  Hosts run(flags, true, stops_at);
  // Who publishes for the others comes back first, or last; then no agent is left.
  const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> losses{
      {{"east"}, {"orbit", "a"}},
      {{"west"}, {"recorder", "b"}},
      {{"east", "west"}, {"recorder", "a", "b", "orbit"}}};
  for (const auto& [agents, nodes] : losses) {
    wait_until_settled(run.address, stops_at - margin);
    for (const std::string& agent : agents) run[agent].kill(SIGKILL);
    for (const std::string& agent : agents) wait_until_lost(run.address, agent);
    for (const std::string& agent : agents) run.start(agent);
    for (const std::string& name : nodes) {
      EXPECT_EQ(run[name].exit_code(60), 1);
      EXPECT_THAT(run[name].output(), HasSubstr("another has taken its place"));
      run.start(name);
    }
    control_master(run.address, 60, {ClockAction::step, between});
    stops_at += between;
  }
  control_master(run.address, 60, {ClockAction::go_on});
  run.expect_all_exit(0, "", 120);
  EXPECT_EQ(digest_in(report), undisturbed);
  EXPECT_EQ(undisturbed.size(), 16u);
  EXPECT_THAT(read_text_file(report),
              HasSubstr(R"("restarts":{"a":2,"b":2,"east":2,"orbit":2,"recorder":2,"west":2})"));
}

}  // namespace
}  // namespace dmise
