// Agents with keys: a run's bytes stay what they are, and nobody speaks in another's name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>

#include "core/base/error.h"
#include "nodes/agent/host_agent.h"
#include "nodes/runtime/master_link/master_link.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/wire/envelope.h"
#include "tests/runtime/key_directory.h"
#include "tests/runtime/network_threads.h"
#include "tests/runtime/toy.h"

namespace dmise {
namespace {

using namespace test;
using testing::HasSubstr;

constexpr std::chrono::seconds patience{30};
constexpr std::chrono::milliseconds in_vain{300};  // how long what must not come is waited for

/// Keys of a run of orbit, cameras a and b, and a recorder that hears truth; the agent "east" may
/// speak for a and orbit, "west" for b and recorder, "elsewhere" for nobody.
struct HostKeys : Keys {
  HostKeys()
      : Keys({"time-master", "broker", "orbit", "a", "b", "elsewhere", operator_name},
             {"recorder"}) {
    make_key(directory, "east", false, {"a", "orbit"});
    make_key(directory, "west", false, {"b", "recorder"});
  }
};

struct SecureRun {
  explicit SecureRun(std::vector<std::string> expected, Tick last_tick = 30)
      : master(with_keys(run_of(std::move(expected), last_tick, 3))) {}
  MasterOptions with_keys(MasterOptions options) const {
    options.keys = keys.directory;
    return options;
  }
  std::future<BrokerResult> start_broker() {
    return std::async(std::launch::async, [this] {
      return run_broker({.master = master.address, .keys = keys.directory});
    });
  }
  HostAgentResult agent_that_fails(const std::string& name) {
    return run_host_agent({.name = name, .master = master.address, .keys = keys.directory});
  }

  HostKeys keys;
  MasterThread master;
};

/// An agent in a thread; `address` once its nodes may join.
struct SecureAgent {
  SecureAgent(const std::string& agent, const SecureRun& run)
      : name(agent), keys(run.keys.directory) {
    std::promise<std::string> bound;
    auto address_future = bound.get_future();
    result = std::async(std::launch::async, [&bound, &run, agent] {
      return run_host_agent({.name = agent,
                             .master = run.master.address,
                             .keys = run.keys.directory,
                             .on_bound = [&](const std::string& at) { bound.set_value(at); }});
    });
    address = address_future.get();
  }
  std::future<NodeResult> start(Participant& participant) const {
    return test::start(participant, NodeOptions{.master = address, .keys = keys, .via = name});
  }
  /// Joins by hand with the key of `who` under the name of `node`, as it would behind this agent.
  v1::Welcome join_as(const std::string& who, const v1::Join& join,
                      std::chrono::nanoseconds within = patience) const {
    zmq::context_t context(1);
    MasterLink link(context, address, nullptr, Security(keys, who, name));
    return link.join(join, within);
  }
  std::string name, keys, address;
  std::future<HostAgentResult> result;
};

v1::Join joining(const std::string& name) {
  v1::Join join;
  join.set_name(name);
  return join;
}

std::string reason_of(const std::function<void()>& attempt) {
  try {
    attempt();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(AgentKeys, LeaveTheBytesOfARunAsTheyAre) {
  constexpr Tick last_tick = 30;
  SecureRun run({"orbit", "a", "b", "recorder"}, last_tick);
  SecureAgent east("east", run), west("west", run);
  auto broker = run.start_broker();
  ToyOrbit orbit;
  ToyCamera a("a"), b("b");
  ToyRecorder recorder({"a", "b"});  // hears truth as well, which goes from node to node
  std::vector<std::future<NodeResult>> nodes;
  nodes.push_back(east.start(orbit));
  nodes.push_back(east.start(a));
  nodes.push_back(west.start(b));
  nodes.push_back(west.start(recorder));
  for (auto& node : nodes) {
    const NodeResult result = node.get();
    EXPECT_EQ(result.exit_code, 0) << result.reason;
    EXPECT_EQ(result.refused, 0u) << result.last_refusal;
  }
  for (SecureAgent* agent : {&east, &west}) {
    const HostAgentResult result = agent->result.get();
    EXPECT_EQ(result.exit_code, 0) << result.reason;
    EXPECT_EQ(result.refused, 0u);
  }
  EXPECT_EQ(run.master.result.get().exit_code, 0);
  EXPECT_EQ(broker.get().refused, 0u);

  ToyOrbit orbit_here;
  ToyCamera a_here("a"), b_here("b");
  ToyRecorder recorder_here({"a", "b"});
  drive({&orbit_here, &a_here, &b_here, &recorder_here}, last_tick);
  EXPECT_TRUE(recorder.record() == recorder_here.record());
}

TEST(AgentKeys, WithoutTheGrantLetNoAgentIn) {
  SecureRun run({"orbit", "a"});
  const HostAgentResult agent = run.agent_that_fails("elsewhere");
  EXPECT_EQ(agent.exit_code, 1);
  EXPECT_THAT(agent.reason, HasSubstr("the key of elsewhere may not speak for nodes"));
  const HostAgentResult nobody = run.agent_that_fails("north");
  EXPECT_EQ(nobody.exit_code, 2);
  EXPECT_THAT(nobody.reason, HasSubstr("north.key: no such key"));
}

TEST(AgentKeys, LetNodesJoinForWhomTheAgentMaySpeak) {
  SecureRun run({"orbit", "a", "b"});
  SecureAgent east("east", run);
  ToyCamera b("b");
  EXPECT_THAT(east.start(b).get().reason, HasSubstr("the key of east may not speak for b"));
  EXPECT_EQ(east.join_as("a", joining("a")).name(), "a");
  // Behind its agent a holds its own key, and says to be orbit.
  EXPECT_THAT(reason_of([&] { east.join_as("a", joining("orbit")); }),
              HasSubstr("the key of a is not that of orbit"));
  // Nor does a key pass for an agent's at the master itself.
  zmq::context_t context(1);
  v1::Join behind = joining("orbit");
  behind.set_host("east");
  for (const char* who : {"a", "west"}) {
    MasterLink link(context, run.master.address, nullptr, Security(run.keys.directory, who));
    EXPECT_THAT(reason_of([&] { link.join(behind, patience); }), HasSubstr("is not that of east"));
  }
  run.master.stop.set();
  EXPECT_EQ(east.result.get().exit_code, 1);
}

TEST(AgentKeys, OpenTheAgentToNobodyElse) {
  SecureRun run({"orbit", "a"});
  SecureAgent east("east", run);
  zmq::context_t context(1);
  const auto is_answered = [&](const Security& security, const char* server,
                               std::chrono::nanoseconds within) {
    auto socket = make_socket(context, zmq::socket_type::dealer, max_control_bytes);
    connect_to(socket, east.address, security, server);
    v1::NodeMessage message;
    *message.mutable_join() = joining("orbit");
    message.mutable_join()->set_observer(true);  // which is refused, but answered
    socket.send(to_frame(message), zmq::send_flags::none);
    std::vector<zmq::pollitem_t> items{{socket.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, within);
    return !receive(socket).empty();
  };
  const Security orbit(run.keys.directory, "orbit");
  EXPECT_TRUE(is_answered(orbit, "east", patience));
  EXPECT_FALSE(is_answered({}, "east", in_vain));            // plain
  EXPECT_FALSE(is_answered(orbit, "west", in_vain));         // takes it for another agent
  EXPECT_FALSE(is_answered(orbit, "time-master", in_vain));  // or for no agent
  const Keys others({"orbit"});                              // a key of one's own making
  std::filesystem::copy_file(run.keys.directory + "/east.pub", others.directory + "/east.pub");
  EXPECT_FALSE(is_answered(Security(others.directory, "orbit"), "east", in_vain));
  run.master.stop.set();
  EXPECT_EQ(east.result.get().exit_code, 1);
}

/// All that observers hear through the broker from somebody who publishes `frames` at `address`
/// time and again, until one of them has come twice: so it was preceded by all others.
std::set<std::string> topics_heard(const std::string& observe, const std::string& address,
                                   const Security& speaking, const Security& listening,
                                   const std::vector<SharedFrames>& frames) {
  zmq::context_t context(1);
  auto publisher = make_socket(context, zmq::socket_type::pub, max_data_bytes);
  connect_to(publisher, address, speaking, broker_name);
  auto listener = make_socket(context, zmq::socket_type::sub, max_data_bytes);
  listener.set(zmq::sockopt::subscribe, "");
  connect_to(listener, observe, listening, broker_name);
  std::multiset<std::string> topics;
  const auto twice = [&] {
    return std::any_of(topics.begin(), topics.end(),
                       [&](const std::string& topic) { return topics.count(topic) > 1; });
  };
  const auto deadline = now() + patience;
  while (!twice() && now() < deadline) {
    for (const auto& message : frames) send(publisher, message);
    std::vector<zmq::pollitem_t> items{{listener.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, std::chrono::milliseconds(20));
    for (auto message = receive(listener); !message.empty(); message = receive(listener))
      topics.insert(message[0].to_string());
  }
  return {topics.begin(), topics.end()};
}

std::vector<SharedFrames> in_the_names_of(const std::vector<std::string>& publishers) {
  std::vector<SharedFrames> all;
  for (const auto& name : publishers)
    all.push_back(std::make_shared<const Frames>(seal("of/" + name, {.publisher = name})));
  return all;
}

TEST(AgentKeys, LetTheBrokerPassOnWhatTheAgentMaySpeakFor) {
  SecureRun run({"orbit", "a"});
  auto broker = run.start_broker();
  const Security asking(run.keys.directory, operator_name);
  BrokerEndpoints endpoints;
  while (endpoints.publish.empty()) endpoints = ask_master(run.master.address, 30, asking).broker;
  // b and the end of orbit's name are not east's; its own name is.
  EXPECT_THAT(
      topics_heard(endpoints.observe, endpoints.publish, Security(run.keys.directory, "east"),
                   asking, in_the_names_of({"b", "bit", "a\norbit", "broker", "a"})),
      testing::ElementsAre("of/a"));
  run.master.stop.set();
  EXPECT_GE(broker.get().refused, 4u);
}

TEST(AgentKeys, LetANodeSpeakForItselfAlone) {
  SecureRun run({"a"});
  auto broker = run.start_broker();
  SecureAgent east("east", run);
  const Security asking(run.keys.directory, operator_name);
  const Security a(run.keys.directory, "a", "east");
  zmq::context_t context(1);
  MasterLink link(context, east.address, nullptr, a);
  v1::Join join = joining("a");
  join.add_produces("of/a");
  link.join(join, patience);
  link.keep({}, std::nullopt);
  const auto deadline = now() + patience;
  while (!link.topology() && now() < deadline) link.wait({}, std::chrono::milliseconds(100));
  ASSERT_TRUE(link.topology());
  const RunStatus status = ask_master(run.master.address, 30, asking);
  ASSERT_NE(link.topology()->publish_endpoint(), status.broker.publish);
  // The agent itself may speak for orbit, but not a by it.
  EXPECT_THAT(topics_heard(status.broker.observe, link.topology()->publish_endpoint(), a, asking,
                           in_the_names_of({"orbit", "east", "b", "a"})),
              testing::ElementsAre("of/a"));
  run.master.stop.set();
  EXPECT_GE(east.result.get().refused, 3u);
  EXPECT_EQ(broker.get().refused, 0u);
}

}  // namespace
}  // namespace dmise
