#pragma once

namespace dmise {

/// Where a run is in its life.
enum class Phase {
  gathering,   // expected nodes join
  connecting,  // all have joined, each makes sure that it hears what it needs
  running,
  ended,   // every tick is done
  failed,  // the time-master knows the cause
};

/// Returns "gathering", "connecting", ...
inline const char* phase_name(Phase phase) {
  switch (phase) {
    case Phase::gathering:
      return "gathering";
    case Phase::connecting:
      return "connecting";
    case Phase::running:
      return "running";
    case Phase::ended:
      return "ended";
    case Phase::failed:
      break;
  }
  return "failed";
}

}  // namespace dmise
