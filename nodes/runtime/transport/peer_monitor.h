#pragma once
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>
#include <zmq.hpp>

namespace dmise {

/// What a socket that others connect to bears with.
struct ConnectionLimits {
  /// Connections of those who have not proved to be somebody: of more, the oldest are closed once
  /// they have had `grace`; of more than `most`, the newest at once.
  std::size_t usual_strangers = 256;
  std::size_t most_strangers = 1024;
  std::chrono::nanoseconds grace = std::chrono::seconds(2);
  /// Bytes of one connection that have come in and that nobody has taken: messages that wait, and a
  /// message of many frames whose last does not come. A stranger's are few, for an empty frame is
  /// two bytes on the way and 64 in ZeroMQ's queue.
  std::int64_t stranger_bytes = 512 << 10;
  std::int64_t known_bytes = 64 << 20;
};

/// Limits for two sockets of a process: as many connections as file descriptors allow, less those
/// that `nodes` nodes need. `share`: of what is left for strangers.
ConnectionLimits limits_for(std::size_t nodes, double share);

/// Bounds the bytes of a connection alone, not how many there are.
ConnectionLimits bytes_alone(std::int64_t stranger_bytes);

/// Knows which node is behind a connection of a socket, tells when a connection breaks, and closes
/// those that go beyond the limits. A hint, not proof: nodes may come back.
class PeerMonitor {
 public:
  /// Without `limits` nothing is closed.
  PeerMonitor(zmq::context_t& context, zmq::socket_t& watched,
              std::optional<ConnectionLimits> limits = std::nullopt);

  /// `frame` came from the node `name`. `guest`: whose connection is held to the bounds of
  /// strangers.
  void belongs(zmq::message_t& frame, const std::string& name, bool guest = false);
  /// Whose connection `frame` came over; "" if it is not known.
  const std::string& name_of(zmq::message_t& frame);
  /// A frame has been taken from the socket.
  void took(zmq::message_t& frame);
  /// Whether answers to the sender of `frame` pile up because it does not read.
  static bool is_stuck(zmq::message_t& frame);
  /// Closes what goes beyond the limits, and tells why: "closed a connection that ...". Looks at
  /// strangers at each call and at others now and then.
  std::vector<std::string> enforce(std::chrono::nanoseconds now);

  /// Connections that broke since the last call. What they brought before is with the watched
  /// socket by then: hear it, then forget them.
  std::vector<std::uint64_t> broken();
  /// Whose connections these are.
  std::vector<std::string> names_of(const std::vector<std::uint64_t>& connections) const;
  /// Forgets them, and gives the nodes that have none left.
  std::vector<std::string> forget(const std::vector<std::uint64_t>& connections);
  void* handle() { return events_.handle(); }
  std::size_t size() const { return at_.size(); }

 private:
  struct Connection {
    int fd = -1;
    std::string name;
    bool guest = true;
    bool closed = false;  // by us
    std::chrono::nanoseconds since{0};
    std::int64_t taken_bytes = 0;
  };
  void hear();
  std::uint64_t add(int fd);
  Connection* connection_of(zmq::message_t& frame);
  void look_at(Connection& connection, std::vector<std::string>* closed) const;

  zmq::socket_t& watched_;
  zmq::socket_t events_;
  std::optional<bool> sealed_;  // each frame of CURVE is longer on the way
  std::optional<ConnectionLimits> limits_;
  std::map<std::uint64_t, Connection> connections_;  // by the order in which they came
  std::map<int, std::uint64_t> at_;                  // those that are open, by file descriptor
  std::vector<std::uint64_t> broken_;
  std::uint64_t count_ = 0;
  std::chrono::nanoseconds next_look_{0};  // at those who are known
};

}  // namespace dmise
