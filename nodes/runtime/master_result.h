#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "nodes/runtime/time_split.h"

namespace dmise {

/// How a run went, as its master saw it.
struct MasterResult {
  int exit_code = 0;                       // 0: every tick was done
  std::string reason;                      // first cause of a code other than 0
  Tick granted = -1;                       // last tick granted
  double wall_s = 0.0;                     // from the first grant to the end
  std::map<std::string, TimeSplit> times;  // of each process, as of its last word
  std::vector<std::string> dropped;        // nodes that the run went on without
};

/// One JSON object: status, cause, granted_tick, wall_s, dropped, and the time split of each node.
std::string to_json(const MasterResult& result);

}  // namespace dmise
