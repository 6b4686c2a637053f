#pragma once
#include "core/visibility/sensor_track.h"

namespace dmise {

/// How fast a camera moves and turns over some time, in the axes in which objects are bounded.
struct CameraMotion {
  double speed_m_per_s = 0.0;   // in TEME
  double turn_rad_per_s = 0.0;  // of its own axes, in TEME
};

/// From the camera at two instants some seconds apart, with a quarter more. Still for a camera
/// fixed to the Earth, in axes that turn with it; 0 turn for one that keeps to the stars; infinite
/// where the camera is there at one of the instants alone, 0 where at none.
CameraMotion camera_motion(const SensorTrack& track, const CameraMoment& a, const CameraMoment& b);

/// The greater of each.
CameraMotion either(const CameraMotion& a, const CameraMotion& b);

}  // namespace dmise
