#pragma once
#include <string>
#include <utility>

#include "core/base/sim_time.h"
#include "sensors/observatory/device_error.h"

namespace dmise {

/// A part that goes evenly to where it is sent: a focuser, a filter wheel, a cover. Times that
/// calls are given must not decrease. Calls throw `DeviceError`.
class Drive {
 public:
  /// `name`: in messages. `rate_per_s`: > 0, of its position.
  Drive(std::string name, double position, double rate_per_s)
      : name_(std::move(name)), rate_per_s_(rate_per_s), from_(position), to_(position) {}

  double position(SimTime now) const;
  double goal() const { return to_; }
  bool is_moving(SimTime now) const { return position(now) != to_; }
  void move_to(double position, SimTime now);
  /// Stays where it is.
  void halt(SimTime now) { halt_at(position(now), now); }
  /// Stays at a place that it passes.
  void halt_at(double position, SimTime now);

  /// A shutter is open until `end`: it does not move until then.
  void hold_until(SimTime end) { held_until_ = end; }
  /// Refuses what moves it while a shutter is open.
  void need_rest(SimTime now) const;
  /// Refuses an exposure while it moves.
  void need_still(SimTime now) const;

 private:
  std::string name_;
  double rate_per_s_, from_, to_;
  SimTime since_, held_until_;
};

}  // namespace dmise
