#pragma once
#include <atomic>

#include "core/config/node_kinds.h"
#include "core/propagation/environment_source.h"
#include "core/sim/participant.h"

namespace dmise {

/// Publishes what all sensors share (Sun, Moon, the Earth's motion and orientation), and the
/// atmosphere above each ground sensor. Each has its own rate, starting at tick 0.
class EnvironmentActor : public Actor {
 public:
  EnvironmentActor(const Scenario& scenario, Clock clock)
      : source_(scenario, scenario.sensors, std::move(clock)) {}

  std::string name() const override { return environment_node; }
  std::vector<std::string> produces() const override;
  Schedule schedule_of(const std::string& topic) const override {
    return {.period = topic == environment_topic ? source_.common_period() : source_.site_period()};
  }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;
  std::uint64_t progress() const override { return steps_; }

 private:
  EnvironmentSource source_;
  std::atomic<std::uint64_t> steps_{0};
};

}  // namespace dmise
