#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/propagation/environment_source.h"
#include "core/propagation/object_states.h"
#include "sensors/scene/frame_times.h"
#include "sensors/scene/state_window.h"

namespace dmise {

/// The states around exposures of one sensor, computed: what its node would have heard from the
/// nodes of objects and environment. Calls are const and may run concurrently.
class StateWindowSource {
 public:
  /// `scenario` and `sensor` must outlive it. `environment_every_s`: least time between two
  /// environments, which run on by their rates in between; 0: as often as the run has them.
  StateWindowSource(const Scenario& scenario, const SensorConfig& sensor, const Clock& clock,
                    double environment_every_s = 0.0);

  /// Ticks that the states of an exposure are interpolated from.
  KnotTicks ticks_of(const FrameTimes& commanded) const;

  /// The states that an exposure needs.
  StateWindow around(const FrameTimes& commanded, const ObjectPopulation& population,
                     const StateSource& states) const;
  /// The states of that exposure and of all before it.
  StateWindow until(const FrameTimes& commanded, const ObjectPopulation& population,
                    const StateSource& states) const;

 private:
  StateWindow between(KnotTicks ticks, SimTime end, const ObjectPopulation& population,
                      const StateSource& states) const;

  const Scenario& scenario_;
  const SensorConfig& sensor_;
  EnvironmentSource environment_;
  Tick environment_period_;
};

/// Environments within an exposure need be no closer [s]: in that time the Sun is off by 1.3 m,
/// 1e-11 rad.
inline constexpr double close_environments_s = 0.1;

/// The states of some objects alone, ascending indices, over one exposure: with knots of its own
/// instead of the run's ticks, and one environment. `earth`: in mid exposure.
StateWindow window_of_some(std::shared_ptr<const ObjectRoster> roster,
                           std::shared_ptr<const EnvironmentState> environment,
                           const EarthOrientation& earth, const ExposureSpan& span,
                           std::vector<std::uint32_t> objects, const StateSource& states);

}  // namespace dmise
