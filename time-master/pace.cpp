#include "time-master/pace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace dmise {

Pace::Pace(PaceOptions options, Tick first_tick) : options_(options), first_tick_(first_tick) {
  if (!(options_.factor >= 0.0) || std::isinf(options_.factor))
    throw ConfigError("real_time: must be a factor >= 0, got " + std::to_string(options_.factor));
  if (options_.tick_length.ns < 1) throw ConfigError("tick: must be >= 1 ns");
}

void Pace::start(Instant now) { epoch_ = now; }

void Pace::step(Tick ticks) {
  if (pause_after_) *pause_after_ += ticks;
}

void Pace::go_on(Instant now) {
  if (!pause_after_) return;
  const Tick next = *pause_after_ + 1;
  pause_after_.reset();
  if (timed() && epoch_ && next >= first_tick_) *epoch_ += std::max(Instant{0}, now - due(next));
}

void Pace::finished(Tick tick, Instant now) {
  if (!timed() || !epoch_ || paused()) return;
  const Instant lag = now - due(tick + 1);
  if (lag <= Instant{0}) return;
  ++overruns_;
  worst_lag_ = std::max(worst_lag_, lag);
}

Tick Pace::limit(Instant now) const {
  Tick limit = pause_after_.value_or(std::numeric_limits<Tick>::max());
  if (paused() || !timed()) return limit;
  if (!epoch_ || now < *epoch_) return first_tick_ - 1;
  const double ticks =
      double((now - *epoch_).count()) * options_.factor / double(options_.tick_length.ns);
  if (ticks > 9e15) return limit;  // beyond the integers of doubles
  // Rounding may be off by one at the very instant at which a tick is due.
  Tick tick = first_tick_ + Tick(ticks);
  while (due(tick + 1) <= now) ++tick;
  while (tick >= first_tick_ && due(tick) > now) --tick;
  return tick;
}

std::optional<Instant> Pace::due_after(Tick granted) const {
  if (!timed() || !epoch_ || paused()) return std::nullopt;
  return due(granted + 1);
}

Instant Pace::due(Tick tick) const {
  const double wall_ns =
      double(tick - first_tick_) * double(options_.tick_length.ns) / options_.factor;
  return *epoch_ + Instant(std::llround(std::min(wall_ns, 4e18)));
}

}  // namespace dmise
