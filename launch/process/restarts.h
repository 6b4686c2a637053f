#pragma once
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "launch/process/supervisor.h"
#include "nodes/runtime/observability/status.h"

namespace dmise {

/// Restarts nodes that have died, or that the time-master has not heard for too long, if the
/// scenario says `on_silent_node: restart`.
class Restarts {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  Restarts(Supervisor& processes, const NetworkConfig& network)
      : processes_(processes), network_(network) {}

  /// `status`: the latest of the master. Returns the restarts with reasons, one line each.
  std::vector<std::string> check(const RunStatus& status, Instant now);

 private:
  std::string reason(const Child& child, const RunStatus& status, Instant now) const;

  Supervisor& processes_;
  const NetworkConfig& network_;
  std::map<std::string, Instant> last_;  // time of the last restart
};

}  // namespace dmise
