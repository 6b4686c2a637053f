#include "time-master/pace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr double longest_wait_ns = 4e18;  // two of them after any present fit into an Instant

void check(double factor) {
  if (!(factor >= 0.0 && factor <= max_pace_factor))
    throw ConfigError("real_time: must be a factor from 0 to 1e6, got " + std::to_string(factor));
}

}  // namespace

Pace::Pace(PaceOptions options, Tick first_tick) : options_(options), anchor_tick_(first_tick) {
  check(options_.factor);
  if (options_.tick_length.ns < 1) throw ConfigError("tick: must be >= 1 ns");
}

void Pace::start(Instant now) { epoch_ = now; }

void Pace::pause(Tick tick, Tick next, Instant now) {
  go_on(next, now);
  pause_after_ = tick;
}

void Pace::step(Tick ticks, Tick next) {
  if (!pause_after_) return;
  stepped_ = stepped_ || paused(next);
  *pause_after_ += ticks;
}

void Pace::go_on(Tick next, Instant now) {
  if (!pause_after_) return;
  pause_after_.reset();
  stepped_ = false;
  schedule(next, part_until(next, now), now);
}

void Pace::change(double factor, Tick next, Instant now) {
  check(factor);
  const double part = part_until(next, now);
  options_.factor = factor;
  schedule(next, part, now);
}

double Pace::wall_ns_per_tick() const {
  return std::min(double(options_.tick_length.ns) / options_.factor, longest_wait_ns);
}

double Pace::part_until(Tick next, Instant now) const {
  if (!timed() || !epoch_) return 1.0;
  return std::clamp(double((due(next) - now).count()) / wall_ns_per_tick(), 0.0, 1.0);
}

void Pace::schedule(Tick next, double part, Instant now) {
  if (!timed() || !epoch_) return;
  anchor_tick_ = next;
  *epoch_ = now + Instant(std::llround(std::min(part * wall_ns_per_tick(), longest_wait_ns)));
}

void Pace::finished(Tick tick, Instant now) {
  if (!timed() || !epoch_ || stepped_ || paused(tick + 1) || tick + 1 < anchor_tick_) return;
  const Instant lag = now - due(tick + 1);
  if (lag <= Instant{0}) return;
  ++overruns_;
  worst_lag_ = std::max(worst_lag_, lag);
}

Tick Pace::limit(Instant now) const {
  const Tick limit = pause_after_.value_or(std::numeric_limits<Tick>::max());
  if (stepped_ || !timed()) return limit;
  if (!epoch_ || now < *epoch_) return anchor_tick_ - 1;
  const double ticks =
      double((now - *epoch_).count()) * options_.factor / double(options_.tick_length.ns);
  if (ticks > 9e15) return limit;  // beyond the integers of doubles
  // Rounding may be off by one at the very instant at which a tick is due.
  Tick tick = anchor_tick_ + Tick(ticks);
  while (due(tick + 1) <= now) ++tick;
  while (tick >= anchor_tick_ && due(tick) > now) --tick;
  return std::min(tick, limit);
}

std::optional<Instant> Pace::due_after(Tick granted) const {
  if (!timed() || !epoch_ || stepped_ || paused(granted + 1)) return std::nullopt;
  return due(granted + 1);
}

Instant Pace::due(Tick tick) const {
  const double wall_ns = double(tick - anchor_tick_) * wall_ns_per_tick();
  return *epoch_ + Instant(std::llround(std::min(wall_ns, longest_wait_ns)));
}

}  // namespace dmise
