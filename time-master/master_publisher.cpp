#include "time-master/master_publisher.h"

#include <algorithm>
#include <utility>

#include "nodes/runtime/process/seconds.h"
#include "nodes/runtime/transport/socket.h"
#include "time-master/master_messages.h"

namespace dmise {
namespace {

/// Manifests go only to a topic's consumers if there are at least so many processes for each.
constexpr std::size_t min_crowd = 8;

}  // namespace

void MasterPublisher::reply(std::string_view routing_id, const v1::MasterMessage& message) {
  router_.send(zmq::buffer(routing_id), zmq::send_flags::sndmore);
  router_.send(to_frame(message), zmq::send_flags::none);
}

void MasterPublisher::refuse(std::string_view routing_id, const std::string& reason,
                             const std::string& name) {
  v1::MasterMessage answer;
  answer.mutable_refuse()->set_name(name);
  answer.mutable_refuse()->set_reason(reason);
  reply(routing_id, answer);
}

void MasterPublisher::index_consumers() {
  consumed_ = directory_.consumed();
  narrow_.clear();
  std::size_t connected = 0;
  std::map<std::string, std::set<std::string>> consumers;
  std::set<std::string> observed;
  for (const auto& [name, peer] : directory_.all()) {
    const std::string& host = peer.join.host();
    connected += host.empty();
    for (const std::string& topic : peer.join.consumes()) {
      consumers[topic].insert(host.empty() ? name : host);
      if (peer.join.observer()) observed.insert(topic);
    }
  }
  for (const auto& [topic, names] : consumers)
    if (names.size() * min_crowd <= connected && !observed.contains(topic))
      narrow_[topic].assign(names.begin(), names.end());
}

void MasterPublisher::note(const TickTally& tally) {
  for (const TopicTally& topic : tally.topics) {
    if (!consumed_.contains(topic.topic)) continue;
    const auto narrow = narrow_.find(topic.topic);
    if (narrow == narrow_.end()) {
      add_published(&fresh_, tally.tick, topic);
    } else {
      for (const std::string& name : narrow->second)
        add_published(&fresh_for_[name], tally.tick, topic);
    }
  }
}

bool MasterPublisher::publish_changes() {
  if (coordinator_.phase() == phase_ && coordinator_.granted() == granted_ &&
      coordinator_.topology_version() == topology_version_ && fresh_.published().empty()) {
    publish_to_few();
    return false;
  }
  phase_ = coordinator_.phase();
  granted_ = coordinator_.granted();
  if (coordinator_.topology_version() != topology_version_) send_topology();
  publish();
  return true;
}

void MasterPublisher::publish() {
  describe(&grant_, run_id_, coordinator_);
  grant_.mutable_published()->Swap(fresh_.mutable_published());
  fresh_.clear_published();
  ticks_.send(to_frame(grant_), zmq::send_flags::none);
  publish_to_few();
}

void MasterPublisher::publish_to_few() {
  if (fresh_for_.empty()) return;
  v1::MasterMessage message = grant();
  for (auto& [name, fresh] : std::exchange(fresh_for_, {})) {
    const auto peer = directory_.all().find(name);
    if (peer == directory_.all().end()) continue;
    message.mutable_grant()->mutable_published()->Swap(fresh.mutable_published());
    reply(peer->second.routing_id, message);
  }
}

v1::MasterMessage MasterPublisher::welcome(const std::string& name,
                                           const std::string& tick_endpoint,
                                           std::uint64_t heartbeat_token) const {
  const CoordinatorOptions& options = coordinator_.options();
  v1::MasterMessage answer;
  auto* welcome = answer.mutable_welcome();
  welcome->set_run_id(run_id_);
  const Coordinator::Member& member = coordinator_.member_of(name);
  welcome->set_name(name);
  welcome->set_incarnation(member.incarnation);
  welcome->set_resume_tick(member.resumes_at);
  welcome->set_tick_ns(options.pace.tick_length.ns);
  welcome->set_last_tick(options.last_tick);
  welcome->set_window_ticks(std::uint32_t(options.window_ticks));
  welcome->set_heartbeat_s(to_seconds(options.heartbeat));
  welcome->set_silent_after_s(to_seconds(options.silent_after));
  welcome->set_progress_after_s(to_seconds(options.progress_after));
  welcome->set_tick_endpoint(tick_endpoint);
  welcome->set_heartbeat_token(heartbeat_token);
  return answer;
}

v1::MasterMessage MasterPublisher::grant() const {
  v1::MasterMessage answer;
  describe(answer.mutable_grant(), run_id_, coordinator_);
  return answer;
}

v1::MasterMessage MasterPublisher::grant_for(const Coordinator::Member& member) const {
  v1::MasterMessage answer = grant();
  const auto& needs = member.node.consumes;
  const std::set<std::string, std::less<>> wanted(needs.begin(), needs.end());
  for (const auto& [name, other] : coordinator_.members())
    for (const TickTally& tally : other.manifests)
      for (const TopicTally& topic : tally.topics)
        if (wanted.contains(topic.topic)) add_published(answer.mutable_grant(), tally.tick, topic);
  return answer;
}

v1::MasterMessage MasterPublisher::expelled(const std::string& cause) const {
  v1::MasterMessage answer = grant();
  answer.mutable_grant()->set_phase(v1::PHASE_FAILED);
  answer.mutable_grant()->set_cause(cause);
  return answer;
}

void MasterPublisher::send_topology() {
  topology_version_ = coordinator_.topology_version();
  index_consumers();
  const v1::Topology topology = directory_.topology();
  for (const auto& [name, peer] : directory_.all()) send_topology_to(peer, topology);
}

void MasterPublisher::send_topology_to(const Peer& peer, const v1::Topology& topology) {
  if (!peer.join.host().empty()) return;  // its agent informs it
  const std::string& name = peer.join.name();
  v1::MasterMessage message;
  *message.mutable_topology() = topology_for(name, topology, coordinator_);
  if (peer.join.agent()) {
    for (const std::string& topic : coordinator_.members().at(name).node.produces)
      if (consumed_.contains(topic)) message.mutable_topology()->add_reported(topic);
  }
  if (peer.join.observer()) directory_.make_for_observer(message.mutable_topology());
  reply(peer.routing_id, message);
}

void MasterPublisher::send_again(const std::string& name) {
  const auto peer = directory_.all().find(name);
  const auto member = coordinator_.members().find(name);
  if (peer == directory_.all().end() || member == coordinator_.members().end()) return;
  if (topology_version_ > 0) send_topology_to(peer->second, directory_.topology());
  reply(peer->second.routing_id, grant_for(member->second));
}

void MasterPublisher::announce_observer(const std::string& name) {
  const auto before = std::exchange(consumed_, {});
  index_consumers();
  const bool more =
      !std::includes(before.begin(), before.end(), consumed_.begin(), consumed_.end());
  const v1::Topology topology = directory_.topology();
  for (const auto& [other, peer] : directory_.all())
    if (other == name || (more && peer.join.agent())) send_topology_to(peer, topology);
}

}  // namespace dmise
