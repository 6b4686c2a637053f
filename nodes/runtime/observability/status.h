#pragma once
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "core/sim/run_phase.h"
#include "nodes/runtime/protocol/time_split.h"
#include "nodes/runtime/security/security.h"

namespace dmise {

namespace v1 {
class Endpoints;
}

struct NodeStatus {
  std::string name;
  Tick done = -1;
  bool alive = true;
  bool observer = false;
  std::uint64_t incarnation = 1;
  TimeSplit times;
  std::vector<std::string> consumes;  // topics
};

/// Addresses of a broker.
struct BrokerEndpoints {
  std::string publish, subscribe, observe;
};

/// State of a run as reported by its time-master.
struct RunStatus {
  std::uint64_t run_id = 0;
  Phase phase = Phase::gathering;
  std::string cause;
  Tick granted = -1;
  Tick last_tick = 0;
  SimTime tick_length;
  std::string start_utc;        // when tick 0 is; empty if unknown
  std::string scenario_digest;  // empty if unknown
  Tick settled = -1;            // last tick done by all
  bool paused = false;
  double pace = 0.0;           // simulated seconds per second asked for; 0: as fast as possible
  std::uint64_t overruns = 0;  // ticks behind real time
  double worst_lag_s = 0.0;
  std::uint64_t digest = 0;  // everything published in settled ticks
  BrokerEndpoints broker;    // where the last broker is; empty before the first
  std::vector<NodeStatus> nodes;
  std::vector<std::string> missing;
  std::vector<std::string> holding;  // nodes that the clock waits for
};

/// Converts the master's answer.
RunStatus status_of(const v1::Endpoints& answer);

/// Values are those of Control.Action in proto/dmise/v1/node.proto.
enum class ClockAction { pause = 1, step, go_on, end_early, abort, pace };

struct ClockRequest {
  ClockAction action = ClockAction::pause;
  Tick tick = 0;            // to pause after, or number of steps
  double factor = 0.0;      // pace: simulated seconds per second, 0 to 1e6; 0: as fast as possible
  std::string reason = {};  // to end
};

/// Controls the clock and returns the resulting state. Throws as `ask_master`.
RunStatus control_master(const std::string& address, double within_s, const ClockRequest& request,
                         const Security& security = {});

/// Queries the master at `address`. Throws `Error` if it does not answer in time.
RunStatus ask_master(const std::string& address, double within_s, const Security& security = {});

}  // namespace dmise
