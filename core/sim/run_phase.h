#pragma once

namespace dmise {

/// Phase of a run; values are those of Phase in proto/dmise/v1/time.proto.
enum class Phase {
  gathering = 1,  // expected nodes join
  connecting,     // all have joined and check their subscriptions
  running,
  ended,   // every tick is done
  failed,  // see the time-master for the cause
};

/// Returns "gathering", "connecting", ...
inline const char* phase_name(Phase phase) {
  constexpr const char* names[] = {"gathering", "connecting", "running", "ended", "failed"};
  return names[int(phase) - int(Phase::gathering)];
}

}  // namespace dmise
