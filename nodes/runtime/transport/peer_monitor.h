#pragma once
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>
#include <zmq.hpp>

namespace dmise {

/// Limits of a socket that others connect to.
struct ConnectionLimits {
  /// Limits of anonymous connections: beyond this number, the oldest are closed after `grace`;
  /// beyond `most`, the newest at once.
  std::size_t usual_strangers = 256;
  std::size_t max_strangers = 1024;
  std::chrono::nanoseconds grace = std::chrono::seconds(2);
  /// Bytes of one connection received but not read: waiting messages, and incomplete messages of
  /// many frames. Small for anonymous connections, because an empty frame has two bytes on the wire
  /// and 64 in ZeroMQ's queue.
  std::int64_t stranger_bytes = 512 << 10;
  std::int64_t known_bytes = 64 << 20;
};

/// Limits for two sockets of a process: as many connections as file descriptors allow, minus those
/// that `nodes` nodes need. `share`: fraction for anonymous connections.
ConnectionLimits limits_for(std::size_t nodes, double share);

/// Limits the bytes of each connection only, not the number of connections.
ConnectionLimits bytes_alone(std::int64_t stranger_bytes);

/// Maps connections of a socket to nodes, reports broken connections, and closes those beyond the
/// limits. A broken connection is a hint, not a proof: nodes may reconnect.
class PeerMonitor {
 public:
  PeerMonitor(zmq::context_t& context, zmq::socket_t& watched, const ConnectionLimits& limits);

  /// `frame` came from the node `name`. `guest`: the limits of anonymous connections apply.
  void identify(zmq::message_t& frame, const std::string& name, bool guest = false);
  /// Name of the connection of `frame`; "" if unknown.
  const std::string& name_of(zmq::message_t& frame);
  /// A frame was read from the socket.
  void count_read(zmq::message_t& frame);
  /// Whether replies to the sender of `frame` accumulate because it does not read.
  static bool is_stuck(zmq::message_t& frame);
  /// Closes connections beyond the limits and returns log lines: "closed a connection that ...".
  /// Checks anonymous connections at each call, others from time to time.
  std::vector<std::string> enforce(std::chrono::nanoseconds now);

  /// Connections that broke since the last call. Their messages are still in the watched socket:
  /// read them, then forget the connections.
  std::vector<std::uint64_t> broken();
  /// Names of connections.
  std::vector<std::string> names_of(const std::vector<std::uint64_t>& connections) const;
  /// Forgets connections and returns the nodes without any left.
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
  void read_events();
  Connection* connection_of(zmq::message_t& frame);
  void look_at(Connection& connection, std::vector<std::string>* closed) const;

  zmq::socket_t& watched_;
  zmq::socket_t events_;
  std::optional<bool> sealed_;  // frames of CURVE are longer on the wire
  ConnectionLimits limits_;
  std::map<std::uint64_t, Connection> connections_;  // by order of arrival
  std::map<int, std::uint64_t> at_;                  // open ones, by file descriptor
  std::vector<std::uint64_t> broken_;
  std::uint64_t count_ = 0;
  std::chrono::nanoseconds next_look_{0};  // at known nodes
};

}  // namespace dmise
