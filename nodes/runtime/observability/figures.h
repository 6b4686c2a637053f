#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "core/base/sim_time.h"
#include "nodes/runtime/protocol/time_split.h"
#include "nodes/wire/refusal.h"

namespace dmise {

/// Counters of a node, since the start of its process.
struct NodeFigures {
  Tick granted = -1;
  Tick done = -1;
  bool computing = false;  // inside a step
  std::uint64_t incarnation = 1;
  std::uint64_t ticks = 0;  // steps performed
  std::uint64_t sent = 0;   // messages
  std::uint64_t sent_bytes = 0;
  std::uint64_t received = 0;  // messages that passed every check
  std::array<std::uint64_t, std::size_t(Refusal::count)> refused{};
  std::uint64_t resend_requests = 0;
  std::uint64_t missed = 0;
  std::uint64_t queued = 0;  // messages received but not yet used
  TimeSplit times;
};

/// Time of a sensor's frames by stages, all frames of this process.
struct FrameFigures {
  struct Stage {
    double predicted_s = 0.0, measured_s = 0.0;
  };
  std::map<std::string, Stage> stages;
};

struct BrokerFigures {
  std::uint64_t messages = 0;  // forwarded
  std::uint64_t refused = 0;   // under another name than their sender's
};

}  // namespace dmise
