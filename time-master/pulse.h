#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "time-master/pace.h"

namespace dmise {

/// Timeouts after which a process counts as lost.
struct PulseLimits {
  Instant silent_after = std::chrono::seconds(5);          // after its death
  Instant heartbeat{0};                                    // interval of heartbeats
  Instant suspect_after = std::chrono::milliseconds(750);  // after its connection broke
  Instant progress_after{0};                               // longest step without progress; 0: any

  // A dying process has been heard up to one heartbeat before; another heartbeat is allowed for
  // delays here. Progress is known with the next heartbeat.
  Instant silence() const { return silent_after - std::min(heartbeat, silent_after / 2); }
  Instant step() const { return progress_after - std::min(heartbeat, progress_after / 2); }
};

/// Signs of life of one process.
struct Pulse {
  bool computing = false;
  std::uint64_t progress = 0;
  Instant heard{0};
  Instant progressed{0};
  std::optional<Instant> suspected;  // since its connection broke
  std::optional<Instant> stalled;    // idle since, although all wait for it

  /// Initial state of a new process.
  static Pulse begin(Instant now) { return {.heard = now, .progressed = now}; }
  void heard_at(Instant now);
  void beat(bool is_computing, std::uint64_t step_progress, Instant now);
  void suspect(Instant now);
  /// This process was suspended between `since` and `now` and could not receive anything.
  void excuse(Instant since, Instant now);
  /// Returns why the process counts as lost, "has been silent for 5.0 s"; empty while it is alive.
  /// A process without progress is lost only if `steps_matter`.
  std::string trouble(const PulseLimits& limits, bool steps_matter, Instant now) const;
  /// When it will be lost unless more is heard until then.
  Instant deadline(const PulseLimits& limits, bool steps_matter) const;
};

/// "5.0 s"
std::string in_seconds(Instant duration);

}  // namespace dmise
