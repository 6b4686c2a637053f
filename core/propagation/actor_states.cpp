#include "core/propagation/actor_states.h"

#include <set>

#include "core/base/error.h"

namespace dmise {

bool ActorStates::add(const Message& message) {
  const auto* states = std::get_if<ObjectStates>(message.state.get());
  if (!states || !message.topic.starts_with(actor_prefix)) return false;
  const std::string node = message.topic.substr(std::string_view(actor_prefix).size());
  states_[node][states->tick] = {message.state, states};
  return true;
}

const ObjectStates* ActorStates::of(const std::string& node, Tick tick, std::size_t place) const {
  const auto of_node = states_.find(node);
  if (of_node == states_.end()) return nullptr;
  const auto found = of_node->second.find(tick);
  if (found == of_node->second.end()) return nullptr;
  if (place >= found->second->count)
    throw Error(actor_prefix + node + ": has states of " + std::to_string(found->second->count) +
                " objects at tick " + std::to_string(tick) + ", which are too few");
  return found->second.get();
}

void ActorStates::forget_before(Tick tick) {
  for (auto& [node, ticks] : states_) ticks.erase(ticks.begin(), ticks.lower_bound(tick));
}

std::vector<std::string> actor_topics(std::span<const OwnObject> objects) {
  std::set<std::string> nodes;
  for (const OwnObject& object : objects) {
    if (const NodeMotion* motion = motion_by_node(object)) nodes.insert(motion->node);
    if (const NodeAttitude* attitude = attitude_by_node(object)) nodes.insert(attitude->node);
  }
  std::vector<std::string> topics;
  for (const std::string& node : nodes) topics.push_back(actor_prefix + node);
  return topics;
}

}  // namespace dmise
