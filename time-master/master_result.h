#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "nodes/runtime/protocol/time_split.h"
#include "time-master/coordinator.h"
#include "time-master/tick_log.h"

namespace dmise {

/// Outcome of a run, as seen by its master.
struct MasterResult {
  int exit_code = 0;                       // 0: every tick was done
  bool ended = false;                      // in order, also early on request
  std::string reason;                      // first cause of a code other than 0
  Tick granted = -1;                       // last tick granted
  double wall_s = 0.0;                     // from the first grant to the end
  std::map<std::string, TimeSplit> times;  // by process, as last reported
  std::vector<std::string> dropped;        // nodes that the run continued without
  std::map<std::string, int> restarts;     // number of restarts, if any
  std::uint64_t digest = 0;                // everything published; the same for the same run
  std::uint64_t overruns = 0;              // ticks not done when the next was due in real time
  double worst_lag_s = 0.0;
  std::uint64_t messages = 0;                  // received from the first grant to the end
  double cpu_s = 0.0;                          // master's whole process in that time
  std::vector<TickRecord> ticks;               // the latest
  std::map<std::string, double> waited_for_s;  // in which the clock waited for a node
};

/// Result of a coordinator's run.
MasterResult result_of(const Coordinator& coordinator);

/// One JSON object: status, cause, granted_tick, wall_s, digest, overruns, worst_lag_s, dropped,
/// restarts, the time split of each node, and the latest ticks.
std::string to_json(const MasterResult& result);

}  // namespace dmise
