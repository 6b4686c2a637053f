#pragma once
#include <string>

#include "nodes/runtime/observability/status.h"

namespace dmise::test {

/// Returns when the master at `address` counts `name` as lost.
inline void wait_until_lost(const std::string& address, const std::string& name) {
  for (bool lost = false; !lost;)
    for (const NodeStatus& node : ask_master(address, 60).nodes)
      lost = lost || (node.name == name && !node.alive);
}

/// Returns when all have done `tick`, or the run is over.
inline void wait_until_settled(const std::string& address, Tick tick) {
  for (bool settled = false; !settled;) {
    const RunStatus run = ask_master(address, 60);
    settled = run.settled >= tick || run.phase == Phase::ended || run.phase == Phase::failed;
  }
}

}  // namespace dmise::test
