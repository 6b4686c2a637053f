#include "orbit-node/orbit_actor.h"

#include <algorithm>
#include <utility>

namespace dmise {
namespace {

constexpr std::int64_t check_every_ns = 60'000'000'000;  // for absent objects

}  // namespace

OrbitActor::OrbitActor(const Scenario& scenario, const Clock& clock, Threads& threads)
    : OrbitActor(scenario, clock, load_objects(scenario, clock), threads) {}

OrbitActor::OrbitActor(const Scenario& scenario, Clock clock, ObjectPopulation population,
                       Threads& threads)
    : tick_length_(scenario.tick),
      last_tick_(scenario.last_tick()),
      publishes_states_(scenario.network.publish_states || scenario.nodes_take_states()),
      actor_topics_(actor_topics(scenario.own_objects)),
      population_(std::move(population)),
      source_(population_, std::move(clock), threads),
      reported_(population_.roster.objects.size()) {}

std::vector<std::string> OrbitActor::produces() const {
  if (!publishes_states_) return {roster_topic};
  return {roster_topic, objects_topic};
}

std::vector<std::string> OrbitActor::consumes() const {
  if (!publishes_states_) return {};
  return actor_topics_;
}

std::vector<Message> OrbitActor::rosters(Tick tick) const {
  const auto roster = std::make_shared<const State>(published_roster(population_));
  std::vector<Message> messages;
  for (auto& topic : produces()) messages.push_back({std::move(topic), tick, roster});
  return messages;
}

std::vector<Message> OrbitActor::resume(Tick tick, std::span<const Message>) {
  if (tick == 0) return {};  // published by the step
  return rosters(tick);
}

bool OrbitActor::is_checked(Tick tick) const {
  const Tick every = std::max<Tick>(1, check_every_ns / tick_length_.ns);
  return report_ && (tick % every == 0 || tick == last_tick_);
}

std::vector<Message> OrbitActor::step(Tick tick, std::span<const Message> inputs) {
  for (const Message& message : inputs) told_.add(message);
  std::vector<Message> messages;
  if (tick == 0) messages = rosters(tick);
  if (publishes_states_ || is_checked(tick)) {
    ObjectStates states = source_.at(tick, {tick * tick_length_.ns}, &told_);
    report_absent(states);
    if (publishes_states_)
      messages.push_back({objects_topic, tick, std::make_shared<State>(std::move(states))});
  }
  told_.forget_before(tick + 1);
  ++steps_;
  return messages;
}

void OrbitActor::report_absent(const ObjectStates& states) {
  if (!report_) return;
  for (std::size_t i = 0; i < states.count; ++i) {
    const bool unknown = !publishes_states_ && states.code[i] == std::uint8_t(MotionCode::untold);
    if (states.code[i] == 0 || unknown || reported_[i]) continue;
    reported_[i] = true;
    report_(source_.why_absent(i, states));
  }
}

}  // namespace dmise
