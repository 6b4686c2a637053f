#pragma once
#include <optional>

#include "core/base/instant.h"
#include "core/base/sim_time.h"

namespace dmise {

struct PaceOptions {
  SimTime tick_length{1'000'000'000};
  double factor = 0.0;  // simulated seconds per second; 0: as fast as possible
};

/// Limits how far the clock may advance, independent of nodes: real time times a factor, pauses,
/// single steps. Late ticks are never skipped: the clock catches up, and the overrun is counted.
class Pace {
 public:
  /// Throws `ConfigError` for a factor that is not 0 to max_pace_factor.
  explicit Pace(PaceOptions options = {}, Tick first_tick = 0);

  /// `first_tick` is due now.
  void start(Instant now);
  /// No tick after `tick` until `step` or `go_on`; those until then come at the pace. `next`: the
  /// first that is not granted, due as by `go_on` if there was a pause before.
  void pause(Tick tick, Tick next, Instant now);
  /// If there is a pause, allows `ticks` more; at once, if it has begun.
  void step(Tick ticks, Tick next);
  /// Ends a pause. `next`, the first tick that is not granted, is due as soon as it was at the
  /// pause: at most a tick from now. Ticks that were late are due from now on; no overrun.
  void go_on(Tick next, Instant now);
  /// Simulated time passes at another factor from now on, also what is left of a tick until `next`
  /// is due; otherwise as `go_on`. A pause stays. Throws `ConfigError` as the constructor.
  void change(double factor, Tick next, Instant now);
  /// All nodes have done `tick`.
  void finished(Tick tick, Instant now);

  /// Whether a pause has begun; `next` as in `pause`.
  bool paused(Tick next) const { return pause_after_ && next > *pause_after_; }
  double factor() const { return options_.factor; }
  /// Last tick that may be granted.
  Tick limit(Instant now) const;
  /// When the tick after `granted` is due; empty if it is independent of real time.
  std::optional<Instant> due_after(Tick granted) const;

  /// Ticks that were not done when the next was due, and the largest delay; not of ticks that were
  /// granted before the last change of their schedule.
  std::uint64_t overruns() const { return overruns_; }
  Instant worst_lag() const { return worst_lag_; }

 private:
  bool timed() const { return options_.factor > 0.0; }
  Instant due(Tick tick) const;
  /// Part of a tick until `next` is due, [0, 1]; 1 if it is independent of real time.
  double part_until(Tick next, Instant now) const;
  void schedule(Tick next, double part, Instant now);
  double wall_ns_per_tick() const;

  PaceOptions options_;
  Tick anchor_tick_;
  std::optional<Instant> epoch_;  // when anchor_tick_ is due
  std::optional<Tick> pause_after_;
  bool stepped_ = false;  // in this pause: ticks do not wait for real time
  std::uint64_t overruns_ = 0;
  Instant worst_lag_{0};
};

}  // namespace dmise
