#pragma once
#include <string>

#include "core/propagation/object_population.h"
#include "core/propagation/object_states.h"
#include "sensors/objects/state_window_source.h"

namespace dmise {

/// Returns the element set of a text: a TLE with or without a name, or an OMM. Throws `DeviceError`
/// if there is none, or more than one.
MeanElements elements_in(const std::string& text);

/// Where a satellite is seen over a sensor on the ground, by elements that need not be the
/// scenario's: with light time, aberration and refraction, as its frames have them.
class SatellitePath {
 public:
  /// `scenario` and `sensor` must outlive it.
  SatellitePath(const Scenario& scenario, const SensorConfig& sensor, const Clock& clock,
                const MeanElements& elements);

  /// Throws `Error` where it has no state.
  Vec<Enu> seen(SimTime t) const;

 private:
  const Scenario& scenario_;
  const SensorConfig& sensor_;
  ObjectPopulation population_;  // one object
  mutable Threads threads_;
  StateSource states_;
  StateWindowSource windows_;
};

}  // namespace dmise
