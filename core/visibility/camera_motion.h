#pragma once
#include <span>

#include "core/visibility/sensor_track.h"

namespace dmise {

/// How fast a camera moves and turns over some instants, in the axes in which objects are bounded.
struct CameraMotion {
  bool with_earth = false;      // axes that turn with the Earth: it stands still in them
  double speed_m_per_s = 0.0;   // in TEME otherwise
  double turn_rad_per_s = 0.0;  // of its own axes, in TEME
};

/// From the camera at instants `step_s` apart, with a quarter more. 0 turn for a camera that keeps
/// to the stars.
CameraMotion camera_motion(const SensorTrack& track, std::span<const CameraMoment> moments,
                           double step_s);

}  // namespace dmise
