#pragma once
#include <cstdint>
#include <set>
#include <vector>

#include "core/config/scenario.h"
#include "core/propagation/object_states.h"
#include "core/time/clock.h"
#include "nodes/environment/environment_actor.h"
#include "sensors/pipeline/frame_times.h"
#include "sensors/pipeline/objects_in_field.h"
#include "sensors/pipeline/world.h"

namespace dmise {

/// The subset of a population. `indices` ascend.
ObjectPopulation only_these(const ObjectPopulation& all, const std::set<std::size_t>& indices);

/// Worlds around frames of one sensor, as published by the run's actors.
class FrameWorlds {
 public:
  /// `scenario` and `sensor` must outlive it.
  FrameWorlds(const Scenario& scenario, const SensorConfig& sensor, const Clock& clock);

  struct Ticks {
    Tick first = 0, last = 0;
  };
  /// Ticks that the states of a frame are interpolated from.
  Ticks ticks_of(const FrameTimes& commanded) const;

  World around(const FrameTimes& commanded, const ObjectPopulation& population,
               const StateSource& source);

 private:
  const Scenario& scenario_;
  const SensorConfig& sensor_;
  EnvironmentActor environment_;
};

/// `count` of the frames 1 to `frames`, including the first and the last.
std::vector<std::uint32_t> evenly(std::uint32_t frames, std::uint32_t count);

}  // namespace dmise
