#pragma once
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "nodes/runtime/time_split.h"
#include "time-master/coordinator.h"

namespace dmise {

struct NodeStatus {
  std::string name;
  Tick done = -1;
  bool alive = true;
  TimeSplit times;
};

/// What the time-master tells anybody who asks.
struct RunStatus {
  std::uint64_t run_id = 0;
  Phase phase = Phase::gathering;
  std::string cause;
  Tick granted = -1;
  Tick last_tick = 0;
  SimTime tick_length;
  std::string observe_endpoint;  // subscribe here; empty while there is no broker
  std::vector<NodeStatus> nodes;
  std::vector<std::string> missing;
  std::vector<std::string> holding;  // who holds the clock
};

/// Asks the master at `address`. Throws `Error` when it does not answer in time.
RunStatus ask_master(const std::string& address, double within_s);

}  // namespace dmise
