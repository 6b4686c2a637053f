#include "core/visibility/camera_motion.h"

#include <algorithm>
#include <limits>

#include "core/frames/rotation_angle.h"

namespace dmise {
namespace {

constexpr double margin = 1.25;

}  // namespace

CameraMotion camera_motion(const SensorTrack& track, const CameraMoment& a, const CameraMoment& b) {
  if (track.fixed_to_earth() || (!a.there && !b.there)) return {};
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (!a.there || !b.there) return {.speed_m_per_s = infinite, .turn_rad_per_s = infinite};
  const double share = margin / (b.time - a.time).seconds();
  CameraMotion motion{.speed_m_per_s = share * norm(b.apex_m - a.apex_m)};
  if (!track.fixed_to_stars())
    motion.turn_rad_per_s =
        share * rotation_angle_rad(a.camera_from_teme * b.camera_from_teme.inverse());
  return motion;
}

CameraMotion either(const CameraMotion& a, const CameraMotion& b) {
  return {std::max(a.speed_m_per_s, b.speed_m_per_s), std::max(a.turn_rad_per_s, b.turn_rad_per_s)};
}

}  // namespace dmise
