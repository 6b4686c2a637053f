// What an agent passes on to its nodes, without a network.
#include <gtest/gtest.h>

#include "nodes/agent/host_publisher.h"
#include "nodes/runtime/transport/socket.h"

namespace dmise {
namespace {

/// An agent's side of the conversation with the node "orbit", process 2 of its name.
struct Voice {
  Voice() {
    node.set(zmq::sockopt::routing_id, "orbit-2");
    router.bind("inproc://agent");
    node.connect("inproc://agent");
    node.send(zmq::str_buffer("join"), zmq::send_flags::none);
    EXPECT_EQ(receive(router).size(), 2u);
    v1::Join join;
    join.set_name("orbit");
    directory.add("orbit-2", 2, join, 0);
  }
  /// What the node hears of a topology in which this process of its name begins at `tick`.
  std::optional<v1::Topology> told(std::uint64_t incarnation, Tick tick) {
    v1::Topology topology;
    auto* start = topology.add_starts();
    start->set_name("orbit");
    start->set_incarnation(incarnation);
    start->set_resume_tick(tick);
    start->set_from_tick(tick);
    voice.send_topology(topology, "publish", "subscribe", "password");
    const auto frame = receive_one(node);
    v1::MasterMessage message;
    if (!frame || !from_frame(*frame, &message)) return std::nullopt;
    return message.topology();
  }
  zmq::context_t context{1};
  zmq::socket_t router{context, zmq::socket_type::router};
  zmq::socket_t ticks{context, zmq::socket_type::pub};
  zmq::socket_t node{context, zmq::socket_type::dealer};
  PeerDirectory directory;
  HostPublisher voice{router, ticks, directory};
};

TEST(HostPublisher, TellsANodeWhereItBeginsAndThatTheAgentIsItsBroker) {
  Voice agent;
  const auto topology = agent.told(2, 40);
  ASSERT_TRUE(topology);
  EXPECT_EQ(topology->resume_tick(), 40);
  EXPECT_EQ(topology->publish_endpoint(), "publish");
  EXPECT_EQ(topology->subscribe_endpoint(), "subscribe");
  EXPECT_EQ(topology->starts_size(), 0);
}

// The master may have said it for another node's sake, before it heard of this process.
TEST(HostPublisher, KeepsFromAProcessWhatIsMeantForTheOneBefore) {
  Voice agent;
  EXPECT_FALSE(agent.told(1, 0));
  EXPECT_EQ(agent.told(2, 40)->resume_tick(), 40);
}

}  // namespace
}  // namespace dmise
