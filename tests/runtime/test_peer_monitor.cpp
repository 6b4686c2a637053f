// What a socket bears with of those who connect to it.
#include "nodes/runtime/transport/peer_monitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/transport/socket.h"
#include "tests/runtime/raw_peer.h"

namespace dmise {
namespace {

using std::chrono::seconds;
using test::RawPeer;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A socket that others connect to, and who watches it.
struct Place {
  explicit Place(zmq::socket_type type, const ConnectionLimits& limits)
      : socket(make_socket(context, type, max_control_bytes)), monitor(context, socket, limits) {
    if (type == zmq::socket_type::router) socket.set(zmq::sockopt::rcvhwm, 100);
    address = bind_to(socket, "tcp://127.0.0.1:0");
  }
  /// Waits until so many connections are open.
  bool has(std::size_t connections) {
    const auto deadline = now() + seconds(20);
    while (monitor.size() != connections && now() < deadline) {
      const auto more = monitor.broken();
      broken.insert(broken.end(), more.begin(), more.end());
    }
    return monitor.size() == connections;
  }
  zmq::context_t context{1};
  zmq::socket_t socket;
  PeerMonitor monitor;
  std::string address;
  std::vector<std::uint64_t> broken;
};

TEST(ConnectionLimits, CloseAMessageWithoutEnd) {
  Place place(zmq::socket_type::router, {.stranger_bytes = 4 << 20});
  RawPeer peer(place.address, "DEALER");
  const std::string part = RawPeer::frame(std::string(1 << 20, 'x'), true);
  std::vector<std::string> closed;
  int said = 0;
  while (closed.empty() && said < 1000 && peer.say(part)) {
    closed = place.monitor.enforce(now());
    ++said;
  }
  ASSERT_EQ(closed.size(), 1u);
  EXPECT_THAT(closed[0], HasSubstr("closed a connection that sends faster than it is read"));
  EXPECT_LE(said, 30);  // 4 MiB, what the system keeps beside, and one look a MiB
  EXPECT_TRUE(place.has(0));
}

// A peer that is heard may send without end: 64 MiB through a place that bears with 1.
TEST(ConnectionLimits, LetThoseSendWhoAreHeard) {
  Place place(zmq::socket_type::router, {.stranger_bytes = 1 << 20});
  auto peer = make_socket(place.context, zmq::socket_type::dealer, max_control_bytes);
  connect_to(peer, place.address);
  const std::string body(64 << 10, 'x');
  for (int i = 0; i < 1024; ++i) {
    peer.send(zmq::buffer(body), zmq::send_flags::none);
    std::vector<zmq::pollitem_t> items{{place.socket.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, seconds(20));
    auto message = receive(place.socket);
    ASSERT_EQ(message.size(), 2u);
    place.monitor.count_read(message[1]);
    ASSERT_THAT(place.monitor.enforce(now()), IsEmpty());
  }
}

TEST(ConnectionLimits, CloseSubscriptionsWithoutEnd) {
  Place place(zmq::socket_type::pub, {.stranger_bytes = 0});
  auto peer = make_socket(place.context, zmq::socket_type::sub, max_control_bytes);
  connect_to(peer, place.address);
  std::vector<std::string> closed;
  const auto deadline = now() + seconds(20);
  for (int said = 0; closed.empty() && now() < deadline; ++said) {
    if (said < 2000)
      peer.set(zmq::sockopt::subscribe, std::to_string(said) + std::string(200, 'x'));
    closed = place.monitor.enforce(now());
  }
  ASSERT_EQ(closed.size(), 1u);
  EXPECT_THAT(closed[0], HasSubstr("closed a connection"));
}

TEST(ConnectionLimits, CloseStrangersBeyondTheirNumberButNobodyWhoIsKnown) {
  Place place(zmq::socket_type::router, {.usual_strangers = 10, .max_strangers = 20});
  auto known = make_socket(place.context, zmq::socket_type::dealer, max_control_bytes);
  connect_to(known, place.address);
  known.send(zmq::str_buffer("I am a"), zmq::send_flags::none);
  std::vector<zmq::pollitem_t> items{{place.socket.handle(), 0, ZMQ_POLLIN, 0}};
  wait_for(items, seconds(20));
  auto message = receive(place.socket);
  ASSERT_EQ(message.size(), 2u);
  place.monitor.identify(message[1], "a");
  EXPECT_EQ(place.monitor.name_of(message[1]), "a");

  std::vector<std::unique_ptr<RawPeer>> strangers;
  for (int i = 0; i < 30; ++i)
    strangers.push_back(std::make_unique<RawPeer>(place.address, "DEALER"));
  ASSERT_TRUE(place.has(31));
  EXPECT_THAT(place.monitor.enforce(now()),
              ElementsAre(HasSubstr("closed 10 anonymous connections")));
  EXPECT_TRUE(place.has(21));
  // The others have had their time then, and the oldest go.
  EXPECT_THAT(place.monitor.enforce(now() + seconds(3)),
              ElementsAre(HasSubstr("closed 10 anonymous connections")));
  EXPECT_TRUE(place.has(11));
  EXPECT_THAT(place.monitor.enforce(now() + seconds(3)), IsEmpty());
  EXPECT_THAT(place.monitor.forget(place.broken), IsEmpty());  // "a" is there
  EXPECT_EQ(place.monitor.name_of(message[1]), "a");
}

TEST(ConnectionLimits, LeaveRoomForTheNodesOfARun) {
  const ConnectionLimits few = limits_for(3, 0.2), many = limits_for(1000, 0.2);
  EXPECT_GE(few.max_strangers, 16u);
  EXPECT_GE(many.max_strangers, 2000u);  // all join at once
  EXPECT_LE(few.usual_strangers, few.max_strangers);
}

}  // namespace
}  // namespace dmise
