#include "core/forces/proximity.h"

#include <cmath>

#include "core/base/error.h"

namespace dmise {
namespace {

/// Angular velocity of the axes in themselves: h / r^2 about the normal.
Vec<Rtn> turn_of(const MotionState<Gcrs>& chief) {
  const double r_m = norm(chief.position_m);
  return {0.0, 0.0, norm(cross(chief.position_m, chief.velocity_m_per_s)) / (r_m * r_m)};
}

Vec<Rtn> in_rtn(const MotionState<Gcrs>& chief, const Vec<Gcrs>& v) {
  return {dot(gcrs_from_rtn(chief, {1, 0, 0}), v), dot(gcrs_from_rtn(chief, {0, 1, 0}), v),
          dot(gcrs_from_rtn(chief, {0, 0, 1}), v)};
}

double mean_motion_rad_per_s(const MotionState<Gcrs>& state, double gm_m3_per_s2) {
  const double speed = norm(state.velocity_m_per_s);
  const double inverse_m = 2 / norm(state.position_m) - speed * speed / gm_m3_per_s2;
  if (!(inverse_m > 0)) throw Error("its chief is on no closed orbit");
  return std::sqrt(gm_m3_per_s2 * inverse_m) * inverse_m;
}

struct Place {
  const MotionState<Gcrs>& chief_0;
  double time_s, gm_m3_per_s2;

  Vec<Rtn> operator()(const NaturalMotion& motion) const {
    if (motion.dynamics == RelativeDynamics::clohessy_wiltshire)
      return clohessy_wiltshire(motion.start, mean_motion_rad_per_s(chief_0, gm_m3_per_s2), time_s)
          .position_m;
    const auto later = [&](const MotionState<Gcrs>& state) {
      return propagate_two_body(state, time_s, gm_m3_per_s2);
    };
    const MotionState<Gcrs> chief = later(chief_0);
    return in_rtn(chief, later(deputy_state(chief_0, motion.start)).position_m - chief.position_m);
  }
  Vec<Rtn> operator()(const Circumnavigation& m) const {
    const double turned_rad = mean_motion_rad_per_s(chief_0, gm_m3_per_s2) * time_s;
    const double in_plane_rad = turned_rad + m.phase_rad;
    return {m.radial_m * std::sin(in_plane_rad),
            m.centre_transverse_m + 2 * m.radial_m * std::cos(in_plane_rad),
            m.normal_m * std::sin(turned_rad + m.normal_phase_rad)};
  }
  Vec<Rtn> operator()(const ForcedApproach& m) const {
    if (time_s <= m.at_s) return m.from_m;
    if (time_s >= m.end_s()) return m.to_m;
    return m.from_m + unit(m.to_m - m.from_m) * (m.speed_m_per_s * (time_s - m.at_s));
  }
};

}  // namespace

RelativeState clohessy_wiltshire(const RelativeState& start, double n_rad_per_s, double dt_s) {
  const auto& [x, y, z] = start.position_m;
  const auto& [vx, vy, vz] = start.velocity_m_per_s;
  const double n = n_rad_per_s, nt = n * dt_s, s = std::sin(nt), c = std::cos(nt);
  return {
      {(4 - 3 * c) * x + s / n * vx + 2 * (1 - c) / n * vy,
       6 * (s - nt) * x + y - 2 * (1 - c) / n * vx + (4 * s - 3 * nt) / n * vy, c * z + s / n * vz},
      {3 * n * s * x + c * vx + 2 * s * vy, -6 * n * (1 - c) * x - 2 * s * vx + (4 * c - 3) * vy,
       -n * s * z + c * vz}};
}

MotionState<Gcrs> deputy_state(const MotionState<Gcrs>& chief, const RelativeState& relative) {
  return {chief.position_m + gcrs_from_rtn(chief, relative.position_m),
          chief.velocity_m_per_s +
              gcrs_from_rtn(
                  chief, relative.velocity_m_per_s + cross(turn_of(chief), relative.position_m))};
}

RelativeState relative_state(const MotionState<Gcrs>& chief, const MotionState<Gcrs>& deputy) {
  const Vec<Rtn> position_m = in_rtn(chief, deputy.position_m - chief.position_m);
  return {position_m, in_rtn(chief, deputy.velocity_m_per_s - chief.velocity_m_per_s) -
                          cross(turn_of(chief), position_m)};
}

Vec<Rtn> position_m(const ProximityMotion& motion, const MotionState<Gcrs>& chief_0, double time_s,
                    double gm_m3_per_s2) {
  return std::visit(Place{chief_0, time_s, gm_m3_per_s2}, motion);
}

std::vector<double> corners_s(const ProximityMotion& motion) {
  const auto* approach = std::get_if<ForcedApproach>(&motion);
  if (!approach || approach->from_m == approach->to_m) return {};
  return {approach->at_s, approach->end_s()};
}

bool needs_circular_chief(const ProximityMotion& motion) {
  const auto* natural = std::get_if<NaturalMotion>(&motion);
  return std::holds_alternative<Circumnavigation>(motion) ||
         (natural && natural->dynamics == RelativeDynamics::clohessy_wiltshire);
}

double eccentricity_of(const MotionState<Gcrs>& state, double gm_m3_per_s2) {
  const Vec<Gcrs> momentum = cross(state.position_m, state.velocity_m_per_s);
  return norm(cross(state.velocity_m_per_s, momentum) / gm_m3_per_s2 - unit(state.position_m));
}

}  // namespace dmise
