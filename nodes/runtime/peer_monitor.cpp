#include "nodes/runtime/peer_monitor.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>

#include "core/base/error.h"
#include "nodes/runtime/socket.h"

namespace dmise {

PeerMonitor::PeerMonitor(zmq::context_t& context, zmq::socket_t& watched)
    : events_(make_socket(context, zmq::socket_type::pair, max_control_bytes)) {
  static std::atomic<int> count{0};
  const std::string address = "inproc://peers-" + std::to_string(count++);
  if (zmq_socket_monitor(watched.handle(), address.c_str(), ZMQ_EVENT_DISCONNECTED) != 0)
    throw Error("can't watch connections");
  events_.connect(address);
}

void PeerMonitor::belongs(zmq::message_t& frame, const std::string& name) {
  const int connection = zmq_msg_get(frame.handle(), ZMQ_SRCFD);
  if (connection >= 0) name_of_[connection] = name;
}

std::vector<int> PeerMonitor::broken() {
  std::vector<int> connections;
  for (auto event = receive(events_); !event.empty(); event = receive(events_)) {
    // First frame: uint16 event, uint32 file descriptor, in the order of this machine.
    if (event[0].size() < 6) continue;
    std::uint32_t connection = 0;
    std::memcpy(&connection, event[0].data<char>() + 2, sizeof connection);
    connections.push_back(int(connection));
  }
  return connections;
}

std::vector<std::string> PeerMonitor::names_of(const std::vector<int>& connections) const {
  std::vector<std::string> names;
  for (const int connection : connections)
    if (const auto found = name_of_.find(connection); found != name_of_.end())
      names.push_back(found->second);
  return names;
}

std::vector<std::string> PeerMonitor::forget(const std::vector<int>& connections) {
  std::vector<std::string> names = names_of(connections);
  for (const int connection : connections) name_of_.erase(connection);
  std::erase_if(names, [this](const std::string& name) {
    return std::any_of(name_of_.begin(), name_of_.end(),
                       [&](const auto& entry) { return entry.second == name; });
  });
  return names;
}

}  // namespace dmise
