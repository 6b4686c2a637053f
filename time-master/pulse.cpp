#include "time-master/pulse.h"

#include <cstdio>

#include "nodes/runtime/process/seconds.h"

namespace dmise {

std::string in_seconds(Instant duration) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", to_seconds(duration));
  return text;
}

void Pulse::heard_at(Instant now) {
  heard = now;
  suspected.reset();
}

void Pulse::beat(bool is_computing, std::uint64_t step_progress, Instant now) {
  heard_at(now);
  if (!is_computing || !computing || step_progress != progress) progressed = now;
  computing = is_computing;
  if (computing) stalled.reset();
  progress = step_progress;
}

void Pulse::suspect(Instant now) {
  if (!suspected) suspected = now;
}

void Pulse::excuse(Instant since, Instant now) {
  const auto later = [&](Instant t) { return std::min(t + (now - since), now); };
  heard = later(heard);
  progressed = later(progressed);
  if (suspected) suspected = later(*suspected);
  stalled.reset();
}

std::string Pulse::trouble(const PulseLimits& limits, bool steps_matter, Instant now) const {
  const Instant silence = now - heard;
  if (silence >= limits.silence()) return "has been silent for " + in_seconds(silence);
  if (suspected && now - *suspected >= limits.suspect_after) return "has closed its connection";
  if (computing && limits.progress_after.count() > 0 && steps_matter &&
      now - progressed >= limits.step())
    return "has made no progress for " + in_seconds(now - progressed);
  return "";
}

Instant Pulse::deadline(const PulseLimits& limits, bool steps_matter) const {
  Instant first = heard + limits.silence();
  if (suspected) first = std::min(first, *suspected + limits.suspect_after);
  if (computing && limits.progress_after.count() > 0 && steps_matter)
    first = std::min(first, progressed + limits.step());
  return first;
}

}  // namespace dmise
