#pragma once
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "core/sim/run_phase.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/protocol/time_split.h"
#include "nodes/runtime/security/security.h"

namespace dmise {

struct NodeStatus {
  std::string name;
  Tick done = -1;
  bool alive = true;
  bool observer = false;
  std::uint64_t incarnation = 1;
  TimeSplit times;
};

/// Where a broker is bound.
struct BrokerEndpoints {
  std::string publish, subscribe, observe;
};

/// What the time-master tells anybody who asks.
struct RunStatus {
  std::uint64_t run_id = 0;
  Phase phase = Phase::gathering;
  std::string cause;
  Tick granted = -1;
  Tick last_tick = 0;
  SimTime tick_length;
  std::string start_utc;  // of tick 0; empty when the master was not told
  Tick settled = -1;      // all have done it
  bool paused = false;
  std::uint64_t overruns = 0;  // of real time
  double worst_lag_s = 0.0;
  std::uint64_t digest = 0;      // of all that was published in settled ticks
  std::string observe_endpoint;  // subscribe here; empty while there is no broker
  BrokerEndpoints broker;        // of the last broker; empty before the first
  std::vector<NodeStatus> nodes;
  std::vector<std::string> missing;
  std::vector<std::string> holding;  // who holds the clock
};

/// What the master's answer says.
RunStatus status_of(const v1::Endpoints& answer);

enum class ClockAction { pause, step, go_on, end_early, abort };

/// Asks the clock to do something and returns what became of it. `tick`: to pause after, or how
/// many to step.
RunStatus control_master(const std::string& address, double within_s, ClockAction action,
                         Tick tick = 0, const std::string& reason = "",
                         const Security& security = {});

/// Asks the master at `address`. Throws `Error` when it does not answer in time.
RunStatus ask_master(const std::string& address, double within_s, const Security& security = {});

}  // namespace dmise
