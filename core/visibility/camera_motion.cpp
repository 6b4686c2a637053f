#include "core/visibility/camera_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dmise {
namespace {

constexpr double margin = 1.25;

double angle_between(const Rotation<CameraFrame, Teme>& a, const Rotation<CameraFrame, Teme>& b) {
  const Rotation<CameraFrame, CameraFrame> turn = a * b.inverse();
  const auto& m = turn.m;
  const double sine = 0.5 * std::hypot(m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]);
  return std::atan2(sine, 0.5 * (m[0][0] + m[1][1] + m[2][2] - 1.0));
}

}  // namespace

CameraMotion camera_motion(const SensorTrack& track, const CameraMoment& a, const CameraMoment& b) {
  if (track.fixed_to_earth() || (!a.there && !b.there)) return {};
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (!a.there || !b.there) return {.speed_m_per_s = infinite, .turn_rad_per_s = infinite};
  const double share = margin / (b.time - a.time).seconds();
  CameraMotion motion{.speed_m_per_s = share * norm(b.apex_m - a.apex_m)};
  if (!track.fixed_to_stars())
    motion.turn_rad_per_s = share * angle_between(a.camera_from_teme, b.camera_from_teme);
  return motion;
}

CameraMotion either(const CameraMotion& a, const CameraMotion& b) {
  return {std::max(a.speed_m_per_s, b.speed_m_per_s), std::max(a.turn_rad_per_s, b.turn_rad_per_s)};
}

}  // namespace dmise
