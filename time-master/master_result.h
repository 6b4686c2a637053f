#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "nodes/runtime/protocol/time_split.h"
#include "time-master/coordinator.h"

namespace dmise {

/// How a run went, as its master saw it.
struct MasterResult {
  int exit_code = 0;                       // 0: every tick was done
  std::string reason;                      // first cause of a code other than 0
  Tick granted = -1;                       // last tick granted
  double wall_s = 0.0;                     // from the first grant to the end
  std::map<std::string, TimeSplit> times;  // of each process, as of its last word
  std::vector<std::string> dropped;        // nodes that the run went on without
  std::map<std::string, int> restarts;  // processes that followed the first, where there were any
  std::uint64_t digest = 0;             // of all that was published; the same for the same run
  std::uint64_t overruns = 0;           // of real time: ticks not over when the next was due
  double worst_lag_s = 0.0;
  std::uint64_t messages = 0;  // heard from the first grant to the end
  double cpu_s = 0.0;          // of the master's whole process in that time
};

/// What the coordinator knows of it.
MasterResult result_of(const Coordinator& coordinator);

/// One JSON object: status, cause, granted_tick, wall_s, digest, overruns, worst_lag_s, dropped,
/// restarts, and the time split of each node.
std::string to_json(const MasterResult& result);

}  // namespace dmise
