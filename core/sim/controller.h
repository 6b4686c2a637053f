#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "core/sim/participant.h"

namespace dmise {

/// Drives actors and evaluators through the ticks in one process, without a socket: at every tick
/// each participant runs once, after those whose topics it consumes.
class SimulationController {
 public:
  /// Throws `Error` if a consumed topic has no producer, has two, or producers wait for each other.
  explicit SimulationController(std::vector<std::unique_ptr<Participant>> participants);

  /// Runs ticks first..last. After each tick `after_tick(tick)` decides whether to go on. With
  /// `first` > 0 the work of an earlier process is taken up: each participant resumes so early that
  /// those who depend on it can look back.
  void run(Tick last, const std::function<bool(Tick)>& after_tick, Tick first = 0);

  const std::vector<std::unique_ptr<Participant>>& participants() const { return participants_; }

 private:
  std::vector<std::unique_ptr<Participant>> participants_;  // in the order of running
};

}  // namespace dmise
