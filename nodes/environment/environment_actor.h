#pragma once
#include <atomic>

#include "core/config/scenario.h"
#include "core/sim/participant.h"
#include "core/time/clock.h"

namespace dmise {

/// What all sensors share: Sun, Moon, the Earth's motion and orientation, the sky over each sensor.
class EnvironmentActor : public Actor {
 public:
  EnvironmentActor(const Scenario& scenario, Clock clock);

  std::string name() const override { return "environment-node"; }
  std::vector<std::string> produces() const override { return {environment_topic}; }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;
  std::uint64_t progress() const override { return steps_; }

 private:
  SimTime tick_length_;
  Clock clock_;
  std::vector<SkyState> skies_;
  std::atomic<std::uint64_t> steps_{0};
};

}  // namespace dmise
