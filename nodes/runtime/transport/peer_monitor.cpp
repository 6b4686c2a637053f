#include "nodes/runtime/transport/peer_monitor.h"

#include <linux/sockios.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <spdlog/fmt/fmt.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <utility>

#include "core/base/error.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/transport/socket.h"

namespace dmise {
namespace {

using std::chrono::nanoseconds;

constexpr std::int64_t handshake_bytes = 64 << 10;  // allowed beside messages
constexpr nanoseconds look_interval = std::chrono::milliseconds(250);

/// Size of a frame on the wire: ZMTP 3.1 (RFC 37) and, with CURVE (RFC 26), its MESSAGE command.
std::int64_t bytes_on_wire(std::size_t bytes, bool sealed) {
  const std::size_t body = bytes + (sealed ? 33 : 0);
  return std::int64_t(body + (body > 255 ? 9 : 2));
}

/// Bytes received over a connection; empty if the system does not count them.
std::optional<std::int64_t> bytes_brought(int fd) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (getsockopt(fd, IPPROTO_TCP, TCP_INFO, &info, &size) != 0 ||
      size < offsetof(tcp_info, tcpi_bytes_received) + sizeof info.tcpi_bytes_received)
    return std::nullopt;
  int in_system = 0;
  if (ioctl(fd, SIOCINQ, &in_system) != 0) return std::nullopt;
  return std::int64_t(info.tcpi_bytes_received) - in_system;
}

std::string in_mib(std::int64_t bytes) {
  return fmt::format("{:.1f} MiB", double(bytes) / (1 << 20));
}

}  // namespace

ConnectionLimits limits_for(std::size_t nodes, double share) {
  rlimit files{};
  const bool known = getrlimit(RLIMIT_NOFILE, &files) == 0 && files.rlim_cur != RLIM_INFINITY;
  constexpr double own = 128.0;  // descriptors of the process itself
  const double needed = own + 3.0 * double(nodes);
  const double left = known ? share * (double(files.rlim_cur) - needed) : 1024.0;
  ConnectionLimits limits;
  // While nodes join, their connections are still anonymous.
  limits.max_strangers = std::size_t(std::clamp(left, 16.0, 1024.0)) + 2 * nodes;
  limits.usual_strangers = limits.max_strangers / 2;
  return limits;
}

ConnectionLimits bytes_alone(std::int64_t stranger_bytes) {
  constexpr std::size_t any = 1 << 20;
  return {.usual_strangers = any, .max_strangers = any, .stranger_bytes = stranger_bytes};
}

PeerMonitor::PeerMonitor(zmq::context_t& context, zmq::socket_t& watched,
                         const ConnectionLimits& limits)
    : watched_(watched),
      events_(make_socket(context, zmq::socket_type::pair, max_control_bytes)),
      limits_(limits) {
  static std::atomic<int> count{0};
  const std::string address = "inproc://peers-" + std::to_string(count++);
  if (zmq_socket_monitor(watched.handle(), address.c_str(),
                         ZMQ_EVENT_DISCONNECTED | ZMQ_EVENT_ACCEPTED) != 0)
    throw Error("can't watch connections");
  events_.connect(address);
}

void PeerMonitor::read_events() {
  for (auto event = receive(events_); !event.empty(); event = receive(events_)) {
    // First frame: uint16 event, uint32 file descriptor, in the order of this machine.
    if (event[0].size() < 6) continue;
    std::uint16_t what = 0;
    std::uint32_t fd = 0;
    std::memcpy(&what, event[0].data<char>(), sizeof what);
    std::memcpy(&fd, event[0].data<char>() + 2, sizeof fd);
    if (const auto open = at_.find(int(fd)); open != at_.end()) {
      broken_.push_back(open->second);
      at_.erase(open);
    }
    if (what != ZMQ_EVENT_ACCEPTED) continue;
    connections_[++count_] = {.fd = int(fd), .since = now()};
    at_[int(fd)] = count_;
  }
}

PeerMonitor::Connection* PeerMonitor::connection_of(zmq::message_t& frame) {
  const int fd = zmq_msg_get(frame.handle(), ZMQ_SRCFD);
  if (fd < 0) return nullptr;
  auto found = at_.find(fd);
  if (found == at_.end()) {
    read_events();
    found = at_.find(fd);
  }
  return found == at_.end() ? nullptr : &connections_.at(found->second);
}

void PeerMonitor::identify(zmq::message_t& frame, const std::string& name, bool guest) {
  if (Connection* connection = connection_of(frame)) {
    connection->name = name;
    connection->guest = guest;
  }
}

const std::string& PeerMonitor::name_of(zmq::message_t& frame) {
  static const std::string nobody;
  const Connection* connection = connection_of(frame);
  return connection ? connection->name : nobody;
}

void PeerMonitor::count_read(zmq::message_t& frame) {
  Connection* connection = connection_of(frame);
  if (!connection) return;
  if (!sealed_) sealed_ = watched_.get(zmq::sockopt::mechanism) == ZMQ_CURVE;
  connection->taken_bytes += bytes_on_wire(frame.size(), *sealed_);
}

bool PeerMonitor::is_stuck(zmq::message_t& frame) {
  const int fd = zmq_msg_get(frame.handle(), ZMQ_SRCFD);
  int unread = 0, room = 0;
  socklen_t size = sizeof room;
  if (fd < 0 || ioctl(fd, SIOCOUTQ, &unread) != 0 ||
      getsockopt(fd, SOL_SOCKET, SO_SNDBUF, &room, &size) != 0)
    return false;
  return unread > std::max(room / 4, 16 << 10);
}

void PeerMonitor::look_at(Connection& connection, std::vector<std::string>* closed) const {
  const auto brought = bytes_brought(connection.fd);
  const std::int64_t most = connection.guest ? limits_.stranger_bytes : limits_.known_bytes;
  if (!brought || *brought - connection.taken_bytes <= most + handshake_bytes) return;
  connection.closed = true;
  shutdown(connection.fd, SHUT_RDWR);
  closed->push_back(fmt::format("closed a connection{} that sends faster than it is read: {}",
                                connection.name.empty() ? "" : " of " + connection.name,
                                in_mib(*brought - connection.taken_bytes)));
}

std::vector<std::string> PeerMonitor::enforce(nanoseconds now) {
  std::vector<std::string> closed;
  read_events();
  const bool at_all = now >= next_look_;
  if (at_all) next_look_ = now + look_interval;
  std::vector<Connection*> strangers;
  for (const auto& [fd, id] : at_) {
    Connection& connection = connections_.at(id);
    if (connection.closed) continue;
    if (connection.guest || at_all) look_at(connection, &closed);
    if (connection.name.empty() && !connection.closed) strangers.push_back(&connection);
  }
  if (strangers.size() <= limits_.usual_strangers) return closed;
  std::ranges::sort(strangers, {}, &Connection::since);
  auto first = strangers.begin(), last = strangers.end();
  while (std::size_t(last - first) > limits_.usual_strangers &&
         now - (*first)->since >= limits_.grace)
    ++first;
  last = std::min(last, first + std::ptrdiff_t(limits_.max_strangers));
  const std::size_t refused = strangers.size() - std::size_t(last - first);
  if (refused == 0) return closed;
  strangers.erase(first, last);
  for (Connection* connection : strangers) {
    connection->closed = true;
    shutdown(connection->fd, SHUT_RDWR);
  }
  closed.push_back(fmt::format("closed {} anonymous connections: at most {} are allowed", refused,
                               limits_.usual_strangers));
  return closed;
}

std::vector<std::uint64_t> PeerMonitor::broken() {
  read_events();
  return std::exchange(broken_, {});
}

std::vector<std::string> PeerMonitor::names_of(
    const std::vector<std::uint64_t>& connections) const {
  std::vector<std::string> names;
  for (const std::uint64_t id : connections)
    if (const auto found = connections_.find(id);
        found != connections_.end() && !found->second.name.empty())
      names.push_back(found->second.name);
  return names;
}

std::vector<std::string> PeerMonitor::forget(const std::vector<std::uint64_t>& connections) {
  std::vector<std::string> names = names_of(connections);
  for (const std::uint64_t id : connections) connections_.erase(id);
  std::erase_if(names, [this](const std::string& name) {
    return std::any_of(connections_.begin(), connections_.end(),
                       [&](const auto& entry) { return entry.second.name == name; });
  });
  return names;
}

}  // namespace dmise
