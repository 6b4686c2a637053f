#pragma once
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "time-master/coordinator.h"

namespace dmise {

/// Logs lost nodes, and the nodes waited for when the clock has been still for a while.
class ClockWatch {
 public:
  void check(const Coordinator& coordinator, Instant now);

 private:
  std::pair<Tick, std::vector<std::string>> seen_;  // granted tick, and nodes waited for
  Instant quiet_since_{0};
  std::set<std::string> joined_, lost_;  // as last seen, as last logged
};

}  // namespace dmise
