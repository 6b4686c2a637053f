#pragma once
#include <array>
#include <cstdint>

#include "core/base/sim_time.h"
#include "nodes/runtime/protocol/time_split.h"
#include "nodes/wire/refusal.h"

namespace dmise {

/// What a node counts while it runs, since the start of its process.
struct NodeFigures {
  Tick granted = -1;
  Tick done = -1;
  bool computing = false;  // inside a step
  std::uint64_t incarnation = 1;
  std::uint64_t ticks = 0;  // worked on
  std::uint64_t sent = 0;   // messages
  std::uint64_t sent_bytes = 0;
  std::uint64_t received = 0;  // messages that passed every check
  std::array<std::uint64_t, std::size_t(Refusal::count)> refused{};
  std::uint64_t asked_again = 0;
  std::uint64_t missed = 0;
  std::uint64_t queued = 0;  // messages received and not used yet
  TimeSplit times;
};

struct BrokerFigures {
  std::uint64_t messages = 0;  // passed on
  std::uint64_t refused = 0;   // in the name of another than their sender
};

/// What the operating system knows of this process.
struct ProcessFigures {
  double cpu_s = 0.0;  // user and system
  std::uint64_t resident_bytes = 0;
  std::uint64_t open_files = 0;
};
ProcessFigures process_figures();

}  // namespace dmise
