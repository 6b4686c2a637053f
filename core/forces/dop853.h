#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "core/frames/vec.h"
#include "core/orbit/two_body.h"

namespace dmise {

namespace dop853 {
#include "core/forces/dop853_tables.inc"
}  // namespace dop853

/// A state with the acceleration there.
struct FlightPoint {
  double time_s = 0.0;
  MotionState<Gcrs> state;
  Vec<Gcrs> acceleration_m_per_s2;
};

/// The end of one step, and its estimated error: the larger of that of the position and that of the
/// velocity times sqrt(r^3 / gm) [m]. It is not finite if the end is not.
struct FlightStep {
  FlightPoint end;
  double error_m = 0.0;
};

/// One step of `h_s`, forwards or back (< 0), of DOP853, a Runge-Kutta method of order 8 (Hairer,
/// Norsett & Wanner 1993, II.10). `acceleration(time_s, position_m, velocity_m_per_s)` in m/s^2.
template <class Acceleration>
FlightStep dop853_step(const Acceleration& acceleration, const FlightPoint& from, double h_s) {
  using V = Vec<Gcrs>;
  std::array<V, 12> dr, dv;
  dr[0] = from.state.velocity_m_per_s;
  dv[0] = from.acceleration_m_per_s2;
  const auto sum = [](const std::array<V, 12>& slopes, const double* weights, std::size_t count) {
    V out;
    for (std::size_t j = 0; j < count; ++j) {
      const double w = weights[j];
      if (w == 0.0) continue;
      out.x += w * slopes[j].x;
      out.y += w * slopes[j].y;
      out.z += w * slopes[j].z;
    }
    return out;
  };
  const auto moved = [&](const double* weights, std::size_t count) {
    return MotionState<Gcrs>{from.state.position_m + sum(dr, weights, count) * h_s,
                             from.state.velocity_m_per_s + sum(dv, weights, count) * h_s};
  };
  for (std::size_t k = 1; k < 12; ++k) {
    const auto [r, v] = moved(dop853::weights[k], k);
    dr[k] = v;
    dv[k] = acceleration(from.time_s + dop853::nodes[k] * h_s, r, v);
  }
  FlightStep step;
  step.end.time_s = from.time_s + h_s;
  step.end.state = moved(dop853::sum_weights, 12);
  const auto& [r, v] = step.end.state;
  const double distance = norm(r);
  const double turn_s = std::sqrt(distance * distance * distance / earth_gm_m3_per_s2);
  const auto size = [&](const double* weights) {
    return std::max(norm(sum(dr, weights, 12)), turn_s * norm(sum(dv, weights, 12)));
  };
  const double fifth = size(dop853::error5), third = size(dop853::error3);
  const double both = std::sqrt(fifth * fifth + 0.01 * third * third);
  step.error_m = both > 0 ? std::fabs(h_s) * fifth * fifth / both : both;
  step.end.acceleration_m_per_s2 = acceleration(step.end.time_s, r, v);
  return step;
}

}  // namespace dmise
