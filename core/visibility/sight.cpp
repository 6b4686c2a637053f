#include "core/visibility/sight.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

/// Distance by which the segment between two positions misses clearing the Earth; 0 if it is clear.
double behind_earth_m(const Vec<Gcrs>& a_m, const Vec<Gcrs>& b_m, const OblateEarth& earth) {
  const Vec<Gcrs> a = earth.stretched(a_m), b = earth.stretched(b_m), line = b - a;
  const double length_squared = dot(line, line);
  const double at = length_squared > 0.0 ? std::clamp(-dot(a, line) / length_squared, 0.0, 1.0) : 0;
  const double depth = earth.ellipsoid.equatorial_radius_m - norm(a + line * at);
  // Stretching lengthens a vector by at most 1 / (1 - f).
  return std::max(0.0, depth) * (1.0 - earth.ellipsoid.flattening);
}

}  // namespace

Sight::Sight(const SensorConfig& sensor)
    : field_(sensor.camera.optics),
      exclusion_(sensor.camera.exclusion),
      masked_(std::holds_alternative<SiteConfig>(sensor.place)) {
  mask_cos_ = std::cos(sensor.mask_deg * deg);
  mask_sin_ = std::sin(sensor.mask_deg * deg);
}

// The mask is a cone around the zenith with a half angle of 90 deg minus the mask.
double Sight::below_mask_m(const CameraMoment& now, const Vec<Teme>& from_camera_m) const {
  if (mask_sin_ == 0.0) return -dot(from_camera_m, now.up);
  return outside_cone_m(from_camera_m, now.up, mask_sin_, mask_cos_);
}

bool Sight::visible(const CameraMoment& now, const Vec<Teme>& position_m) const {
  if (!now.there || closes_shutter(exclusion_, now.excluded)) return false;
  const Vec<CameraFrame> line = now.from_camera_m(position_m);
  if (!(dot(line, line) > nearest_m * nearest_m)) return false;
  if (!field_.contains(line)) return false;
  if (masked_ && below_mask_m(now, position_m - now.apex_m) > 0.0) return false;
  return !now.sight || now.sight->clear(now.gcrs_from_teme * position_m);
}

double Sight::hidden_m(const CameraMoment& now, const Vec<Teme>& position_m) const {
  double least = field_.outside_m(now.from_camera_m(position_m));
  if (masked_) least = std::max(least, below_mask_m(now, position_m - now.apex_m));
  if (now.sight)
    least = std::max(least, behind_earth_m(now.gcrs_from_teme * now.apex_m,
                                           now.gcrs_from_teme * position_m, now.sight->earth()));
  return least;
}

}  // namespace dmise
