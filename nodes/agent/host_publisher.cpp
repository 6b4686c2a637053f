#include "nodes/agent/host_publisher.h"

#include <algorithm>

#include "nodes/runtime/transport/socket.h"

namespace dmise {
namespace {

bool same_state(const v1::Grant& a, const v1::Grant& b) {
  return a.tick() == b.tick() && a.phase() == b.phase() && a.closed_size() == b.closed_size();
}

}  // namespace

void HostPublisher::reply(std::string_view routing_id, const v1::MasterMessage& message) {
  router_.send(zmq::buffer(routing_id), zmq::send_flags::sndmore);
  router_.send(to_frame(message), zmq::send_flags::none);
}

void HostPublisher::refuse(std::string_view routing_id, const std::string& reason) {
  v1::MasterMessage answer;
  answer.mutable_refuse()->set_reason(reason);
  reply(routing_id, answer);
}

void HostPublisher::set_grant(v1::Grant grant, Tick settled) {
  changed_ = changed_ || !same_state(grant, grant_);
  grant_ = std::move(grant);
  for (auto& [topic, tallies] : manifests_)
    while (!tallies.empty() && tallies.front().tick() <= settled) tallies.pop_front();
}

void HostPublisher::note(const v1::TopicTally& tally) {
  if (!consumed_.contains(tally.topic())) return;
  auto& manifests = manifests_[tally.topic()];
  if (std::ranges::any_of(manifests, [&](const v1::TopicTally& other) {
        return other.tick() == tally.tick() && other.incarnation() == tally.incarnation();
      }))
    return;
  manifests.push_back(tally);
  *fresh_.add_published() = tally;
}

void HostPublisher::publish(bool anyhow) {
  if (!anyhow && !changed_ && fresh_.published().empty()) return;
  changed_ = false;
  grant_.mutable_published()->Swap(fresh_.mutable_published());
  ticks_.send(to_frame(grant_), zmq::send_flags::none);
  grant_.clear_published();
  fresh_.clear_published();
}

v1::MasterMessage HostPublisher::grant_for(const v1::Join& node) const {
  v1::MasterMessage answer;
  *answer.mutable_grant() = grant_;
  for (const std::string& topic : node.consumes())
    if (const auto manifests = manifests_.find(topic); manifests != manifests_.end())
      for (const v1::TopicTally& tally : manifests->second)
        *answer.mutable_grant()->add_published() = tally;
  return answer;
}

v1::MasterMessage HostPublisher::expelled(const std::string& cause) const {
  v1::MasterMessage answer;
  *answer.mutable_grant() = grant_;
  answer.mutable_grant()->set_phase(v1::PHASE_FAILED);
  answer.mutable_grant()->set_cause(cause);
  return answer;
}

void HostPublisher::send_topology(const v1::Topology& topology, const std::string& publish_endpoint,
                                  const std::string& subscribe_endpoint,
                                  const std::string& password, const std::string& only) {
  consumed_ = directory_.consumed();
  v1::MasterMessage message;
  v1::Topology& theirs = *message.mutable_topology() = topology;
  theirs.clear_starts();
  theirs.clear_reported();
  theirs.clear_broker_incarnation();
  theirs.set_publish_endpoint(publish_endpoint);
  theirs.set_subscribe_endpoint(subscribe_endpoint);
  theirs.set_broker_password(password);
  for (const v1::NodeStart& start : topology.starts()) {
    // Manifests from before it joined are meant for its predecessor.
    const Peer* peer = directory_.find(start.name(), start.incarnation());
    if (!peer || (!only.empty() && start.name() != only)) continue;
    theirs.set_resume_tick(start.resume_tick());
    theirs.set_from_tick(start.from_tick());
    reply(peer->routing_id, message);
  }
}

}  // namespace dmise
