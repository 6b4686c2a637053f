#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "core/sim/participant.h"

namespace dmise {

/// Runs actors and evaluators tick by tick in one process, without sockets: each participant runs
/// once per tick, after the producers of its topics.
class SimulationController {
 public:
  /// Throws `Error` if a consumed topic has no producer or two, or for a dependency cycle.
  explicit SimulationController(std::vector<std::unique_ptr<Participant>> participants);

  /// Runs ticks first..last. After each tick `after_tick(tick)` decides whether to continue.
  /// `first` > 0 continues the work of an earlier process: each participant resumes early enough
  /// for the look-back of its consumers.
  void run(Tick last, const std::function<bool(Tick)>& after_tick, Tick first = 0);

  const std::vector<std::unique_ptr<Participant>>& participants() const { return participants_; }

 private:
  std::vector<std::unique_ptr<Participant>> participants_;  // in running order
};

}  // namespace dmise
