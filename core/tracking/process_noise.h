#pragma once
#include <algorithm>
#include <cmath>

#include "core/tracking/orbit_state.h"

namespace dmise {

/// Longest time over which noise is added as if the object moved without forces [s]: in a low
/// orbit it turns by 7 deg.
inline constexpr double noise_span_s = 120.0;

/// The end of the next part of the way from `from` to `to`.
inline SimTime next_noise_time(SimTime from, SimTime to, bool noise) {
  const SimTime span = sim_seconds(noise_span_s);
  if (!noise || (to - from <= span && from - to <= span)) return to;
  return to > from ? from + span : from - span;
}

/// Root L of the covariance L L' that white noise of these spectral densities adds in `dt_s` >= 0:
/// of the acceleration along each axis [m^2/s^3], and of the rates of the scales [(m^2/kg)^2/s].
inline OrbitMatrix process_noise_root(double acceleration, double drag, double srp, double dt_s) {
  OrbitMatrix root = OrbitMatrix::Zero();
  const double t = std::sqrt(acceleration * dt_s);
  for (int axis = 0; axis < 3; ++axis) {
    root(axis, axis) = t * dt_s / std::sqrt(3.0);
    root(axis + 3, axis) = t * std::sqrt(3.0) / 2;
    root(axis + 3, axis + 3) = t / 2;
  }
  root(drag_row, drag_row) = std::sqrt(drag * dt_s);
  root(srp_row, srp_row) = std::sqrt(srp * dt_s);
  return root;
}

}  // namespace dmise
