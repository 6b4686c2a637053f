#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/config/scenario.h"
#include "core/orbit/elements.h"
#include "core/orbit/sgp4_batch.h"
#include "core/sim/participant.h"
#include "core/time/clock.h"

namespace dmise {

/// The objects of a scenario: their facts and element sets, at the same indices.
struct ObjectPopulation {
  ObjectRoster roster;
  std::vector<MeanElements> elements;
  std::vector<std::string> notes;   // one line each: records refused, stale elements
};

/// Reads the scenario's catalogues. An object named by several keeps its first. Throws `ConfigError`
/// if `only` names an object that is not there or nothing is left.
ObjectPopulation load_objects(const Scenario& scenario, const Clock& clock);

/// States of all objects at every tick, in GCRS, by SGP4.
class OrbitActor : public Actor {
 public:
  OrbitActor(const Scenario& scenario, Clock clock, Threads& threads);

  std::string name() const override { return "orbit-node"; }
  std::vector<std::string> produces() const override { return {objects_topic}; }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;
  std::uint64_t progress() const override { return steps_; }

  const std::vector<std::string>& notes() const { return population_.notes; }
  const ObjectRoster& roster() const { return population_.roster; }

 private:
  SimTime tick_length_;
  Clock clock_;
  Threads& threads_;
  ObjectPopulation population_;
  Sgp4Batch batch_;
  std::atomic<std::uint64_t> steps_{0};
};

/// States at one time. Slopes are symmetric differences of the propagator (`slope_half_step_s`).
ObjectStates states_at(const Sgp4Batch& batch, const Clock& clock, Tick tick, SimTime time,
                       Threads& threads);

}  // namespace dmise
