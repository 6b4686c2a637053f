#include "nodes/runtime/peer_monitor.h"

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

std::vector<std::string> PeerMonitor::lost() {
  std::vector<std::string> names;
  for (auto event = receive(events_); !event.empty(); event = receive(events_)) {
    // First frame: uint16 event, uint32 file descriptor, in the order of this machine.
    if (event[0].size() < 6) continue;
    std::uint32_t connection = 0;
    std::memcpy(&connection, event[0].data<char>() + 2, sizeof connection);
    const auto found = name_of_.find(int(connection));
    if (found == name_of_.end()) continue;
    names.push_back(found->second);
    name_of_.erase(found);
  }
  return names;
}

}  // namespace dmise
