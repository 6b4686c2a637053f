#pragma once
#include "core/visibility/sensor_track.h"

namespace dmise {

/// Linear and angular speed of a camera over some time, in the axes in which objects are bounded.
struct CameraMotion {
  double speed_m_per_s = 0.0;   // in TEME
  double turn_rad_per_s = 0.0;  // its own axes turn in TEME
};

/// Bound from the camera at two instants some seconds apart, plus a quarter. Zero for a camera
/// fixed to the Earth, in axes that rotate with it; zero turn for one fixed relative to the stars;
/// infinite if the camera exists at only one of the instants, 0 if at none.
CameraMotion camera_motion(const SensorTrack& track, const CameraMoment& a, const CameraMoment& b);

/// The maximum of each.
CameraMotion either(const CameraMotion& a, const CameraMotion& b);

}  // namespace dmise
