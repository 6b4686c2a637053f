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
  /// Connections that broke since the last call. What they brought before is with the watched
  /// socket by then: hear it, then forget them.
  std::vector<int> broken();
  /// Whose connections these are.
  std::vector<std::string> names_of(const std::vector<int>& connections) const;
  /// Forgets them, and gives the nodes that have none left.
  std::vector<std::string> forget(const std::vector<int>& connections);
  void* handle() { return events_.handle(); }

 private:
  zmq::socket_t events_;
  std::map<int, std::string> name_of_;  // by file descriptor of the connection
};

}  // namespace dmise
