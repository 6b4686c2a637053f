#pragma once
#include <map>
#include <string>
#include <vector>
#include <zmq.hpp>

namespace dmise {

/// Knows which node is behind a connection of a socket, and tells when a connection breaks. A hint,
/// not proof: nodes may come back.
class PeerMonitor {
 public:
  PeerMonitor(zmq::context_t& context, zmq::socket_t& watched);

  /// `frame` came from the node `name`.
  void belongs(zmq::message_t& frame, const std::string& name);
  /// Nodes that have lost a connection since the last call.
  std::vector<std::string> lost();
  void* handle() { return events_.handle(); }

 private:
  zmq::socket_t events_;
  std::map<int, std::string> name_of_;  // by file descriptor of the connection
};

}  // namespace dmise
