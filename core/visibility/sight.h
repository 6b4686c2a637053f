#pragma once
#include "core/visibility/field_of_view.h"
#include "core/visibility/sensor_track.h"

namespace dmise {

/// Visibility of a position for a sensor at an instant: in its true field, above its mask, not
/// behind the Earth, and no shutter closed. Straight lines at one time: neglects light time and
/// aberration (together below 30 arcsec) and refraction (1 arcmin at 45 deg of elevation, 0.57 deg
/// at the horizon).
class Sight {
 public:
  /// Closer objects are the sensor's own platform, under any number: not seen.
  static constexpr double nearest_m = 0.1;

  explicit Sight(const SensorConfig& sensor);

  bool visible(const CameraMoment& now, const Vec<Teme>& position_m) const;

  /// Lower bound of the distance [m] from every visible position; <= 0 if it may be visible.
  /// Changes by at most the motion of the position in the camera's axes plus that of the camera.
  double hidden_m(const CameraMoment& now, const Vec<Teme>& position_m) const;

 private:
  double below_mask_m(const CameraMoment& now, const Vec<Teme>& from_camera_m) const;

  FieldOfView field_;
  Exclusion exclusion_;
  bool masked_ = false;
  double mask_cos_ = 1.0, mask_sin_ = 0.0;
};

}  // namespace dmise
