#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "core/sim/state.h"
#include "core/time/clock.h"

namespace dmise {

/// What all sensors share at one tick.
EnvironmentState environment_at(const Clock& clock, Tick tick, SimTime time);

/// What programs of the user's are told of Sun, Moon and Earth, at one tick after the other: the
/// state at the last whole minute, run on. It depends on the instant alone and costs little: ERFA's
/// series take longer than a simple model of an orbit. Within 0.002 arcsec of `environment_at`.
class EnvironmentByMinutes {
 public:
  explicit EnvironmentByMinutes(Clock clock) : clock_(std::move(clock)) {}
  EnvironmentState at(Tick tick, SimTime time);

 private:
  Clock clock_;
  std::optional<EnvironmentState> minute_;
};

/// The environment of a run at any tick: what all sensors share, and the air over each sensor on
/// the ground. Calls depend on the tick alone, may run concurrently, and need no node: the
/// environment node publishes them every `common_period` and `site_period` ticks from tick 0 on.
class EnvironmentSource {
 public:
  EnvironmentSource(const Scenario& scenario, const std::vector<SensorConfig>& sensors,
                    Clock clock);

  Tick common_period() const { return common_period_; }
  Tick site_period() const { return site_period_; }
  const std::vector<SensorConfig>& ground_sensors() const { return ground_sensors_; }

  /// With the orientations beside it (`EnvironmentState::earth_beside`) if sensors propagate.
  EnvironmentState common(Tick tick) const;
  /// `sensor`: one of `ground_sensors`.
  SiteState site(const SensorConfig& sensor, Tick tick) const;

 private:
  SimTime tick_length_;
  Tick common_period_, site_period_;
  bool sensors_propagate_;
  Clock clock_;
  std::vector<SensorConfig> ground_sensors_;
  std::map<std::string, Turbulence> turbulence_;  // towards the zenith at 500 nm, by sensor
};

}  // namespace dmise
