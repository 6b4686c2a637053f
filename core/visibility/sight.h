#pragma once
#include "core/visibility/field_of_view.h"
#include "core/visibility/sensor_track.h"

namespace dmise {

/// Whether a sensor sees a place at an instant: in its true field, above its mask, not behind the
/// Earth. Straight lines at one time: light time, aberration (together below 30 arcsec) and
/// refraction (1 arcmin at 45 deg of elevation, 0.57 deg at the horizon) are left out.
class Sight {
 public:
  /// Nearer than this is the sensor's own host, under whatever number: not seen.
  static constexpr double nearest_m = 1.0;

  explicit Sight(const SensorConfig& sensor);

  bool visible(const CameraMoment& now, const Vec<Teme>& position_m) const;

  /// At least this far [m] from every place that is visible; <= 0 where it may be visible itself.
  /// Changes by no more than the place moves in the camera's axes, or than the camera moves.
  double hidden_m(const CameraMoment& now, const Vec<Teme>& position_m) const;

 private:
  double below_mask_m(const CameraMoment& now, const Vec<Teme>& from_camera_m) const;

  FieldOfView field_;
  bool masked_ = false;
  double mask_cos_ = 1.0, mask_sin_ = 0.0;
};

}  // namespace dmise
