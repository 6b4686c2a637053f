#include "core/visibility/camera_motion.h"

#include <algorithm>
#include <cmath>

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

CameraMotion camera_motion(const SensorTrack& track, std::span<const CameraMoment> moments,
                           double step_s) {
  if (track.fixed_to_earth()) return {.with_earth = true};
  CameraMotion motion;
  for (std::size_t k = 0; k + 1 < moments.size(); ++k) {
    const CameraMoment &a = moments[k], &b = moments[k + 1];
    if (!a.there || !b.there) continue;
    motion.speed_m_per_s =
        std::max(motion.speed_m_per_s, margin * norm(b.apex_m - a.apex_m) / step_s);
    if (!track.fixed_to_stars())
      motion.turn_rad_per_s =
          std::max(motion.turn_rad_per_s,
                   margin * angle_between(a.camera_from_teme, b.camera_from_teme) / step_s);
  }
  return motion;
}

}  // namespace dmise
