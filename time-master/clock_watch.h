#pragma once
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "time-master/coordinator.h"

namespace dmise {

/// Says on the log who is lost, and whom everybody waits for when nothing has moved for a while.
class ClockWatch {
 public:
  void look(const Coordinator& coordinator, Instant now);

 private:
  std::pair<Tick, std::vector<std::string>> seen_;  // granted, and who holds the clock
  Instant quiet_since_{0};
  std::set<std::string> joined_, lost_;  // as last seen, as last said
};

}  // namespace dmise
