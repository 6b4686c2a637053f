#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/sim_time.h"

namespace dmise {

/// Control of the clock by a viewer: what `dmise clock` does.
struct ClockCommand {
  /// Values are those of Control.Action in proto/dmise/v1/node.proto.
  enum class Action { pause = 1, step = 2, go_on = 3, pace = 6 };
  Action action = Action::pause;
  std::int64_t ticks = 1;  // ticks of a step, [1, max_step_ticks]
  double factor = 0.0;     // pace: simulated seconds per second, [0, max_pace_factor]

  bool operator==(const ClockCommand&) const = default;
};

/// Shows the last state that the gateway keeps at or before a simulation time.
struct PastCommand {
  double time_s = 0.0;

  bool operator==(const PastCommand&) const = default;
};

/// Shows the run as it goes on.
struct LiveCommand {
  bool operator==(const LiveCommand&) const = default;
};

/// Why a message is not a command.
struct CommandError {
  std::string reason;

  bool operator==(const CommandError&) const = default;
};

using ViewerCommand = std::variant<CommandError, ClockCommand, PastCommand, LiveCommand>;

inline constexpr std::size_t max_command_bytes = 1024;
inline constexpr std::int64_t max_step_ticks = 1'000'000;

/// Reads one message of a viewer: `{"do": "pause"}`, `{"do": "step", "ticks": 3}`, `{"do":
/// "go-on"}`, `{"do": "pace", "factor": 10}`, `{"do": "past", "time_s": 40}`, `{"do": "live"}`.
/// Anything else is a `CommandError`.
ViewerCommand parse_viewer_command(std::string_view text);

}  // namespace dmise
