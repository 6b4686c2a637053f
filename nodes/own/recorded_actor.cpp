#include "nodes/own/recorded_actor.h"

#include <utility>
#include <variant>

#include "core/base/error.h"
#include "nodes/own/recorded_run.h"

namespace dmise {

RecordedActor::RecordedActor(const Scenario& scenario, std::string node, const std::string& digest,
                             const std::string& path)
    : node_(std::move(node)), topic_(actor_prefix + node_) {
  const auto ticks = std::size_t(scenario.last_tick() + 1);
  const auto hear = [&](const RecordedState& recorded) {
    if (recorded.state) add(recorded.state, scenario);
    return states_.size() < ticks;
  };
  read_recorded_run(scenario, digest, path, {topic_}, hear, [&] {
    if (states_.empty()) throw ConfigError("has nothing of node " + node_);
    if (states_.size() < ticks)
      throw ConfigError("ends after tick " + std::to_string(states_.size() - 1) + " of node " +
                        node_ + ", the run has " + std::to_string(ticks - 1));
  });
}

void RecordedActor::add(std::shared_ptr<const State> state, const Scenario& scenario) {
  const auto* states = std::get_if<ObjectStates>(state.get());
  if (!states) throw ConfigError("has something else than states of node " + node_);
  const Tick due = Tick(states_.size());
  if (states->tick > due)
    throw ConfigError("lacks tick " + std::to_string(due) + " of node " + node_);
  if (states->tick < due) return;  // said again
  if (states->time != scenario.time_of(due))
    throw ConfigError("tick " + std::to_string(due) + " of node " + node_ + " is not at its time");
  states_.push_back(std::move(state));
}

std::vector<Message> RecordedActor::step(Tick tick, std::span<const Message>) {
  return {{topic_, tick, states_.at(std::size_t(tick))}};
}

}  // namespace dmise
