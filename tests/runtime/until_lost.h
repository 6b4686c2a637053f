#pragma once
#include <string>

#include "nodes/runtime/status.h"

namespace dmise::test {

/// Returns when the master at `address` counts `name` as lost.
inline void wait_until_lost(const std::string& address, const std::string& name) {
  for (bool lost = false; !lost;)
    for (const NodeStatus& node : ask_master(address, 60).nodes)
      lost = lost || (node.name == name && !node.alive);
}

}  // namespace dmise::test
