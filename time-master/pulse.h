#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "time-master/pace.h"

namespace dmise {

/// How long a process may be quiet before it counts as lost.
struct PulseLimits {
  Instant silent_after = std::chrono::seconds(5);          // after its death
  Instant heartbeat{0};                                    // a living process is heard this often
  Instant suspect_after = std::chrono::milliseconds(750);  // after its connection broke
  Instant progress_after{0};                               // longest step without progress; 0: any

  // Whoever dies has said its last word at most a heartbeat before; another is left for whatever
  // delays those who count. Of progress one hears with the next heartbeat.
  Instant silence() const { return silent_after - std::min(heartbeat, silent_after / 2); }
  Instant step() const { return progress_after - std::min(heartbeat, progress_after / 2); }
};

/// The signs of life of one process.
struct Pulse {
  bool computing = false;
  std::uint64_t progress = 0;
  Instant heard{0};
  Instant progressed{0};
  std::optional<Instant> suspected;  // since its connection broke
  std::optional<Instant> stalled;    // since when it does nothing though all wait for it

  /// Of a process that has just come.
  static Pulse begin(Instant now) { return {.heard = now, .progressed = now}; }
  void hear(Instant now);
  void beat(bool is_computing, std::uint64_t step_progress, Instant now);
  void suspect(Instant now);
  /// Whoever counts did itself not run between `since` and `now`: it could hear nobody.
  void excuse(Instant since, Instant now);
  /// Why the process counts as lost, "has been silent for 5.0 s"; empty while it lives. A process
  /// without progress is only lost while `steps_matter`.
  std::string trouble(const PulseLimits& limits, bool steps_matter, Instant now) const;
  /// When there will be trouble unless more is heard until then.
  Instant deadline(const PulseLimits& limits, bool steps_matter) const;
};

/// "5.0 s"
std::string in_seconds(Instant duration);

}  // namespace dmise
