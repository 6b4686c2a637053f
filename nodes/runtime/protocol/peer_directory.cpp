#include "nodes/runtime/protocol/peer_directory.h"

#include <algorithm>

namespace dmise {
namespace {

/// Connections of one process: its heartbeats come over another than that which stands for it, and
/// either may have been replaced.
constexpr std::size_t most_proved = 4;

void fill(v1::Publisher* publisher, const Peer& peer) {
  publisher->set_name(peer.join.name());
  publisher->set_incarnation(peer.incarnation);
  *publisher->mutable_topics() = peer.join.produces();
  *publisher->mutable_direct_topics() = peer.join.produces_direct();
  publisher->set_direct_endpoint(peer.join.direct_endpoint());
  publisher->set_resend_endpoint(peer.join.resend_endpoint());
  publisher->set_frames_endpoint(peer.join.frames_endpoint());
  publisher->set_period_ticks(std::max<std::uint64_t>(1, peer.join.period_ticks()));
  publisher->set_offset_ticks(peer.join.offset_ticks());
  *publisher->mutable_schedules() = peer.join.schedules();
}

}  // namespace

void PeerDirectory::add(std::string_view routing_id, std::uint64_t incarnation,
                        const v1::Join& join, std::uint64_t heartbeat_token) {
  if (const auto earlier = peers_.find(join.name()); earlier != peers_.end())
    names_.erase(earlier->second.routing_id);
  names_[std::string(routing_id)] = join.name();
  peers_[join.name()] = {std::string(routing_id), incarnation, join, heartbeat_token, {}};
}

void PeerDirectory::remove(const std::string& name) {
  const auto peer = peers_.find(name);
  if (peer == peers_.end()) return;
  // A node of a host shares its agent's connection.
  if (const auto own = names_.find(peer->second.routing_id);
      own != names_.end() && own->second == name)
    names_.erase(own);
  peers_.erase(peer);
}

void PeerDirectory::add_behind(std::string_view agent, std::uint64_t incarnation,
                               const v1::Join& join, std::uint64_t heartbeat_token) {
  peers_[join.name()] = {std::string(agent), incarnation, join, heartbeat_token, {}};
}

void PeerDirectory::prove(const std::string& name, std::string_view routing_id) {
  const auto found = peers_.find(name);
  if (found == peers_.end() || found->second.routing_id == routing_id) return;
  auto& proved = found->second.proved;
  if (std::ranges::find(proved, routing_id) != proved.end()) return;
  proved.emplace_back(routing_id);
  if (proved.size() > most_proved) proved.pop_front();
}

std::string PeerDirectory::adopt(std::string_view routing_id) {
  const auto found = std::ranges::find_if(peers_, [&](const auto& entry) {
    const auto& proved = entry.second.proved;
    return std::ranges::find(proved, routing_id) != proved.end();
  });
  if (found == peers_.end()) return "";
  const std::string& name = found->first;
  std::erase(found->second.proved, routing_id);
  names_.erase(found->second.routing_id);
  names_[std::string(routing_id)] = name;
  for (auto& [other, peer] : peers_)
    if (other == name || peer.join.host() == name) peer.routing_id = routing_id;
  return name;
}

std::set<std::string, std::less<>> PeerDirectory::consumed() const {
  std::set<std::string, std::less<>> topics;
  for (const auto& [name, peer] : peers_)
    topics.insert(peer.join.consumes().begin(), peer.join.consumes().end());
  return topics;
}

const std::string& PeerDirectory::name_of(std::string_view routing_id) const {
  static const std::string nobody;
  const auto found = names_.find(routing_id);
  return found != names_.end() ? found->second : nobody;
}

const Peer* PeerDirectory::find(const std::string& name, std::uint64_t incarnation) const {
  const auto found = peers_.find(name);
  return found != peers_.end() && found->second.incarnation == incarnation ? &found->second
                                                                           : nullptr;
}

v1::Topology PeerDirectory::topology() const {
  v1::Topology topology;
  for (const auto& [name, peer] : peers_) {
    if (peer.join.has_broker()) {
      topology.set_broker_incarnation(peer.incarnation);
      topology.set_publish_endpoint(peer.join.broker().publish_endpoint());
      topology.set_subscribe_endpoint(peer.join.broker().subscribe_endpoint());
      topology.set_broker_password(peer.join.broker().password());
    } else if (!peer.join.agent() && !peer.join.observer()) {
      fill(topology.add_publishers(), peer);
    }
  }
  return topology;
}

void PeerDirectory::make_for_observer(v1::Topology* topology) const {
  topology->clear_broker_password();
  const auto broker = peers_.find("broker");
  if (broker == peers_.end()) return;
  const std::string& observe = broker->second.join.broker().observe_endpoint();
  if (!observe.empty()) topology->set_subscribe_endpoint(observe);
}

void PeerDirectory::describe(v1::Endpoints* endpoints) const {
  for (const auto& [name, peer] : peers_) {
    if (peer.join.has_broker()) {
      *endpoints->mutable_broker() = peer.join.broker();
      endpoints->mutable_broker()->clear_password();
      endpoints->set_observe_endpoint(peer.join.broker().observe_endpoint());
    } else if (!peer.join.agent() && !peer.join.observer()) {
      fill(endpoints->add_publishers(), peer);
    }
  }
}

}  // namespace dmise
