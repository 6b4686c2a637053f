#include "core/instrument/pointing_error.h"

#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/frames/quaternion.h"
#include "core/instrument/instrument.h"

namespace dmise {

std::span<const InstrumentParameter> PointingError::parameters() {
  using Kind = InstrumentParameter::Kind;
  static const InstrumentParameter table[] = {
      {"bias_deg", deg, 180.0, Kind::axes, &PointingError::bias_rad,
       "Constant error of the pointing [deg]: right, down, roll."},
      {"bias_arcsec", arcsec, 648000.0, Kind::axes, &PointingError::bias_rad,
       "The same [arcsec]; one of both may be given."},
      {"drift_arcsec_per_s", arcsec, 36000.0, Kind::axes, &PointingError::drift_rad_per_s,
       "Growth of the error [arcsec/s]: right, down, roll."},
      {"jitter_arcsec", arcsec, 36000.0, Kind::rms_of_axes, &PointingError::pointing_rms_rad,
       "Rms error of each exposure [arcsec]: right, down, roll, or one number for the first two."}};
  return table;
}

double PointingError::drift_size_rad_per_s() const {
  return std::hypot(drift_rad_per_s[0], drift_rad_per_s[1], drift_rad_per_s[2]);
}

ErrorBound PointingError::error(int, const PlanFacts& f) {
  // Beyond a pixel other sources enter the frame.
  return f.pointing_error_rad > f.pixel_rad ? not_bounded : f.shifted_by(f.pointing_error_rad);
}

ImageAxes PointingError::at_rad(SimTime t, const ImageAxes& deviate) const {
  ImageAxes sum{};
  for (std::size_t k = 0; k < sum.size(); ++k)
    sum[k] = bias_rad[k] + drift_rad_per_s[k] * t.seconds() + pointing_rms_rad[k] * deviate[k];
  return sum;
}

Rotation<CameraFrame, CameraFrame> true_from_commanded(const ImageAxes& displaced_rad) {
  const auto [x, y, roll] = displaced_rad;
  const double away = std::hypot(x, y);
  // About the axis (-y, x, 0) the boresight turns towards (x, y).
  const double share = away > 0.0 ? std::sin(0.5 * away) / away : 0.5;
  const auto tilt =
      rotation_of<CameraFrame, CameraFrame>({std::cos(0.5 * away), -y * share, x * share, 0.0});
  const auto turn =
      rotation_of<CameraFrame, CameraFrame>({std::cos(0.5 * roll), 0.0, 0.0, std::sin(0.5 * roll)});
  return (tilt * turn).inverse();
}

}  // namespace dmise
