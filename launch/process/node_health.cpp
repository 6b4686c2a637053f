#include "launch/process/node_health.h"

#include <algorithm>

namespace dmise {

std::string health_problem(const RunStatus& status, const std::string& name) {
  if (status.phase == Phase::failed) return "the run has failed: " + status.cause;
  if (name == master_name) return "";
  for (const NodeStatus& node : status.nodes)
    if (node.name == name)
      return node.alive || status.phase == Phase::ended
                 ? ""
                 : "the time-master has lost " + name +
                       " (last tick done: " + std::to_string(node.done) + ")";
  const auto& missing = status.missing;
  const bool expected = std::find(missing.begin(), missing.end(), name) != missing.end();
  return name + (expected ? " has not joined" : " is not a node of this run");
}

}  // namespace dmise
