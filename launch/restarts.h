#pragma once
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "launch/supervisor.h"
#include "nodes/runtime/observability/status.h"

namespace dmise {

/// Starts nodes again that have died, or that the time-master has not heard for too long, where the
/// scenario says `on_silent_node: restart`.
class Restarts {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  Restarts(Supervisor& processes, const NetworkConfig& network)
      : processes_(processes), network_(network) {}

  /// `status`: what the master said last. Returns who was started again and why, one line each.
  std::vector<std::string> look(const RunStatus& status, Instant now);

 private:
  std::string reason(const Child& child, const RunStatus& status, Instant now) const;

  Supervisor& processes_;
  const NetworkConfig& network_;
  std::map<std::string, Instant> last_;  // start of each that was started again
};

}  // namespace dmise
