#include "orbit-node/orbit_actor.h"

#include <utility>

namespace dmise {

OrbitActor::OrbitActor(const Scenario& scenario, Clock clock, Threads& threads)
    : OrbitActor(scenario, clock, load_objects(scenario, clock), threads) {}

OrbitActor::OrbitActor(const Scenario& scenario, Clock clock, ObjectPopulation population,
                       Threads& threads)
    : tick_length_(scenario.tick),
      population_(std::move(population)),
      source_(population_, std::move(clock), threads),
      told_(population_.roster.objects.size()) {}

std::vector<Message> OrbitActor::resume(Tick tick, std::span<const Message>) {
  if (tick == 0) return {};  // published by the step
  return {{objects_topic, tick, std::make_shared<State>(population_.roster)}};
}

std::vector<Message> OrbitActor::step(Tick tick, std::span<const Message>) {
  std::vector<Message> messages;
  if (tick == 0)
    messages.push_back({objects_topic, tick, std::make_shared<State>(population_.roster)});
  ObjectStates states = source_.at(tick, {tick * tick_length_.ns});
  tell_absent(states);
  messages.push_back({objects_topic, tick, std::make_shared<State>(std::move(states))});
  ++steps_;
  return messages;
}

void OrbitActor::tell_absent(const ObjectStates& states) {
  if (!tell_) return;
  for (std::size_t i = 0; i < states.count; ++i) {
    if (states.code[i] == 0 || told_[i]) continue;
    told_[i] = true;
    tell_(source_.why_absent(i, states));
  }
}

}  // namespace dmise
