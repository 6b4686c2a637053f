#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/orbit/two_body.h"
#include "core/tracking/angle_observation.h"
#include "core/tracking/orbit_state.h"

namespace dmise {

/// Empty if Gauss's and Gooding's methods can start from these observations.
inline std::string_view fault_of_three(std::span<const AngleObservation> three) {
  if (three.size() != 3) return "not three observations";
  for (const AngleObservation& o : three)
    if (const auto fault = fault_of(o); !fault.empty()) return fault;
  if (!(three[0].time < three[1].time && three[1].time < three[2].time))
    return "the three times do not increase";
  // An arc as short as its errors tells no curvature, and so no range.
  const double arc = angle_rad(three[0].direction, three[2].direction);
  if (norm(three[0].sensor_m - three[2].sensor_m) < 1e6 &&
      !(arc > std::max(1e-7, 3 * std::max(sigma_rad(three[0]), sigma_rad(three[2])))))
    return "the arc vanishes: the lines of sight are the same";
  return {};
}

/// State `dt_s` later on its conic; false where there is none.
inline bool move_two_body(OrbitState& state, double dt_s) {
  try {
    const TwoBodyState moved = propagate_two_body({state.position_m, state.velocity_m_per_s}, dt_s);
    state.position_m = moved.position_m;
    state.velocity_m_per_s = moved.velocity_m_per_s;
  } catch (const Error&) {
    return false;
  }
  return is_sane(state);
}

/// Adds a state unless one like it (to 1e-4 of distance and speed) is there. All are of one time.
inline void add_distinct(std::vector<OrbitState>& states, const OrbitState& state) {
  for (const OrbitState& s : states)
    if (norm(s.position_m - state.position_m) < 1e-4 * norm(s.position_m) &&
        norm(s.velocity_m_per_s - state.velocity_m_per_s) < 1e-4 * norm(s.velocity_m_per_s))
      return;
  states.push_back(state);
}

}  // namespace dmise
