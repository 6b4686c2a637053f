#include "time-master/pulse.h"

#include <cstdio>

namespace dmise {

std::string in_seconds(Instant duration) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", std::chrono::duration<double>(duration).count());
  return text;
}

void Pulse::hear(Instant now) {
  heard = now;
  suspected.reset();
}

void Pulse::beat(bool is_computing, std::uint64_t step_progress, Instant now) {
  hear(now);
  if (!is_computing || !computing || step_progress != progress) progressed = now;
  computing = is_computing;
  progress = step_progress;
}

void Pulse::suspect(Instant now) {
  if (!suspected) suspected = now;
}

std::string Pulse::trouble(const PulseLimits& limits, bool steps_matter, Instant now) const {
  const Instant silence = now - heard;
  if (silence > limits.silent_after) return "has been silent for " + in_seconds(silence);
  if (suspected && now - *suspected > limits.suspect_after) return "has closed its connection";
  if (computing && limits.progress_after.count() > 0 && steps_matter &&
      now - progressed > limits.progress_after)
    return "has made no progress for " + in_seconds(now - progressed);
  return "";
}

}  // namespace dmise
