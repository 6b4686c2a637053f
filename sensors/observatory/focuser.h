#pragma once
#include "core/config/sensors/sensor_settings.h"
#include "sensors/observatory/drive.h"

namespace dmise {

/// How far a focuser may take the detector from where the camera file has it, both ways [um]: what
/// a blur can be computed for, at most 5 mm. 0: it can't move.
int focus_travel_um(const SensorConfig& sensor);

/// Returns the sensor with its detector further from the focus by `focus_um`, until `end` at least.
SensorConfig focused(SensorConfig sensor, double focus_um, SimTime end);

/// A focuser, in steps of 1 um. In the middle of its way the detector is where the camera file has
/// it; higher positions take it away from the lens. Calls throw `DeviceError`.
class Focuser {
 public:
  static constexpr double step_um = 1.0, rate_per_s = 1000.0;

  explicit Focuser(int travel_um) : middle_(travel_um), drive_("focuser", travel_um, rate_per_s) {}

  int max_step() const { return 2 * middle_; }
  int position(SimTime now) const;
  int goal() const { return int(drive_.goal()); }
  bool is_moving(SimTime now) const { return drive_.is_moving(now); }
  /// [0, max_step].
  void move_to(int position, SimTime now);
  void halt(SimTime now) { drive_.halt_at(position(now), now); }
  /// The way of the detector from where the camera file has it.
  double focus_um(SimTime now) const { return step_um * (position(now) - middle_); }
  void need_still(SimTime now) const { drive_.need_still(now); }
  void hold_until(SimTime end) { drive_.hold_until(end); }

 private:
  int middle_;
  Drive drive_;
};

}  // namespace dmise
