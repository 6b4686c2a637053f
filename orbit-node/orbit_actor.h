#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "core/config/node_kinds.h"
#include "core/propagation/object_states.h"
#include "core/sim/participant.h"
#include "orbit-node/load_objects.h"

namespace dmise {

/// Publishes the roster of a scenario and, if anybody takes them, the states of all its objects at
/// every tick, in GCRS. What nodes of the user's move is as they say.
class OrbitActor : public Participant {
 public:
  OrbitActor(const Scenario& scenario, const Clock& clock, Threads& threads);
  /// For objects that are already loaded.
  OrbitActor(const Scenario& scenario, Clock clock, ObjectPopulation population, Threads& threads);

  std::string name() const override { return orbit_node; }
  std::vector<std::string> produces() const override;
  std::vector<std::string> consumes() const override;
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;
  std::vector<Message> resume(Tick tick, std::span<const Message> past) override;
  std::uint64_t progress() const override { return steps_; }

  /// Calls `report` with one line for each object without a state, at the first such tick; from the
  /// thread that calls `step`. An actor that publishes no states checks one tick a minute.
  void on_absence(std::function<void(const std::string&)> report) { report_ = std::move(report); }

  const std::vector<std::string>& notes() const { return population_.notes; }
  const ObjectRoster& roster() const { return population_.roster; }

 private:
  std::vector<Message> rosters(Tick tick) const;
  bool is_checked(Tick tick) const;
  void report_absent(const ObjectStates& states);

  SimTime tick_length_;
  Tick last_tick_;
  bool publishes_states_;
  std::vector<std::string> actor_topics_;
  ObjectPopulation population_;
  StateSource source_;
  ActorStates told_;
  std::function<void(const std::string&)> report_;
  std::vector<bool> reported_;
  std::atomic<std::uint64_t> steps_{0};
};

}  // namespace dmise
