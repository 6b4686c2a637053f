#pragma once
#include <cstdint>
#include <optional>

#include "core/frames/vec.h"
#include "core/instrument/instrument.h"
#include "sensors/scene/frame_times.h"

namespace dmise {

/// What a sensor does not know of itself in one exposure: its errors, with their jitter drawn.
class ExposureErrors {
 public:
  /// No errors: `exposure` is as it is commanded.
  explicit ExposureErrors(const FrameTimes& exposure) : commanded_(exposure) {}
  /// Those that act in a sensor's exposure. Depends on the arguments alone.
  ExposureErrors(const SensorConfig& sensor, const FrameTimes& commanded, std::uint64_t seed);

  bool of_clock() const { return instrument_.ClockError::applies(); }
  bool of_pointing() const { return instrument_.PointingError::applies(); }
  bool of_vibration() const { return instrument_.Vibration::applies(); }
  /// Whether the camera points elsewhere than it is told to.
  bool displace() const { return of_pointing() || of_vibration(); }
  bool any() const { return of_clock() || displace(); }

  const FrameTimes& commanded() const { return commanded_; }
  /// Returns when the shutter is truly open.
  FrameTimes exposed() const;
  /// Returns what the sensor's clock reads at the true time `t` of the exposure, never outside the
  /// commanded one of all rows.
  SimTime reading(SimTime t) const;
  /// Returns the camera's true axes from those commanded.
  Rotation<CameraFrame, CameraFrame> true_from_commanded(SimTime t) const;

 private:
  FrameTimes commanded_;
  SimTime last_row_delay_;
  Instrument instrument_;
  double clock_jitter_s_ = 0.0;
  ImageAxes pointing_deviate_{}, vibration_rad_{};
};

}  // namespace dmise
