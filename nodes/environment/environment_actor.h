#pragma once
#include <atomic>
#include <map>
#include <optional>
#include <utility>

#include "core/config/node_kinds.h"
#include "core/sim/participant.h"
#include "core/time/clock.h"

namespace dmise {

/// What all sensors share at one tick.
EnvironmentState environment_at(const Clock& clock, Tick tick, SimTime time);

/// What programs of the user's are told of Sun, Moon and Earth, at one tick after the other: that
/// of the last whole minute, run on. It depends on the instant alone, and costs little: the series
/// of ERFA take longer than a simple model of an orbit. Within 0.002 arcsec of `environment_at`.
class EnvironmentByMinutes {
 public:
  explicit EnvironmentByMinutes(Clock clock) : clock_(std::move(clock)) {}
  EnvironmentState at(Tick tick, SimTime time);

 private:
  Clock clock_;
  std::optional<EnvironmentState> minute_;
};

/// Publishes what all sensors share (Sun, Moon, the Earth's motion and orientation), and the
/// atmosphere above each ground sensor. Each has its own rate, starting at tick 0.
class EnvironmentActor : public Actor {
 public:
  EnvironmentActor(const Scenario& scenario, Clock clock);

  std::string name() const override { return environment_node; }
  std::vector<std::string> produces() const override;
  Schedule schedule_of(const std::string& topic) const override {
    return {.period = topic == environment_topic ? common_period_ : site_period_};
  }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;
  std::uint64_t progress() const override { return steps_; }

 private:
  EnvironmentState common(Tick tick) const;
  SiteState site(const SensorConfig& sensor, Tick tick) const;

  SimTime tick_length_;
  Tick common_period_, site_period_;
  bool sensors_propagate_;
  Clock clock_;
  std::vector<SensorConfig> ground_sensors_;
  std::map<std::string, Turbulence> turbulence_;  // towards the zenith at 500 nm, by sensor
  std::atomic<std::uint64_t> steps_{0};
};

}  // namespace dmise
