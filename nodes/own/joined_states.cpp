#include "nodes/own/joined_states.h"

#include <cmath>
#include <limits>

#include "core/orbit/attitude_interpolation.h"
#include "core/orbit/interpolation.h"
#include "core/orbit/motion.h"
#include "core/sim/columns.h"

namespace dmise {
namespace {

constexpr double half_step_of_rates = 1e-4;  // in intervals

/// Angular velocity [rad/s] that turns `from` to `to`, an angle much less than 1 apart.
Vec<Gcrs> rate_between(const Quaternion& from, const Quaternion& to, double dt_s) {
  const double sign =
      from.w * to.w + from.x * to.x + from.y * to.y + from.z * to.z < 0 ? -1.0 : 1.0;
  const double f = 2.0 * sign / dt_s;
  return {f * (-to.w * from.x + to.x * from.w - to.y * from.z + to.z * from.y),
          f * (-to.w * from.y + to.x * from.z + to.y * from.w - to.z * from.x),
          f * (-to.w * from.z - to.x * from.y + to.y * from.x + to.z * from.w)};
}

void join_attitudes(const ObjectStates& before, const ObjectStates& after, double u, double span_s,
                    ObjectStates& joined) {
  const std::size_t m = before.attitude_object.size();
  joined.attitude_object = before.attitude_object;
  joined.gcrs_from_body.assign(4 * m, 0.0);
  joined.attitude_rate_rad_per_s.assign(3 * m, 0.0);
  for (std::size_t k = 0; k < m; ++k) {
    const std::size_t i = before.attitude_object[k];
    const auto start = before.attitude(i), end = after.attitude(i);
    if (!start || !end) continue;
    const auto at = [&](double part) { return interpolate_attitude(part, span_s, *start, *end); };
    const Quaternion q = at(u);
    const Vec<Gcrs> rate = rate_between(at(u - half_step_of_rates), at(u + half_step_of_rates),
                                        2 * half_step_of_rates * span_s);
    set_column(joined.gcrs_from_body, m, k, {q.w, q.x, q.y, q.z});
    set_column(joined.attitude_rate_rad_per_s, m, k, rate);
  }
}

void join_albedos(const ObjectStates& before, const ObjectStates& after, double u,
                  ObjectStates& joined) {
  joined.albedo.assign(before.count, roster_albedo);
  for (std::size_t i = 0; i < before.count; ++i)
    if (const auto start = before.albedo_of(i), end = after.albedo_of(i); start && end)
      joined.albedo[i] = std::lerp(*start, *end, u);
}

}  // namespace

ObjectStates joined_states(const ObjectStates& before, const ObjectStates& after, Tick tick,
                           SimTime time) {
  const std::size_t n = before.count;
  const double span_s = (after.time - before.time).seconds();
  const double u = (time - before.time).seconds() / span_s;
  const HermiteWeights w = hermite_weights(HermiteOrder::cubic, u, span_s);
  ObjectStates joined{.tick = tick, .time = time, .count = n};
  joined.position_m.assign(3 * n, 0.0);
  joined.slope_m_per_s.assign(3 * n, 0.0);
  joined.code.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    joined.code[i] = before.code[i] != 0 ? before.code[i] : after.code[i];
    if (joined.code[i] != 0) continue;
    for (std::size_t j = i; j < 3 * n; j += n) {
      joined.position_m[j] =
          before.position_m[j] * w.position[0] + before.slope_m_per_s[j] * w.slope_s[0] +
          after.position_m[j] * w.position[1] + after.slope_m_per_s[j] * w.slope_s[1];
      joined.slope_m_per_s[j] =
          before.position_m[j] * w.position_per_s[0] + before.slope_m_per_s[j] * w.slope[0] +
          after.position_m[j] * w.position_per_s[1] + after.slope_m_per_s[j] * w.slope[1];
    }
  }
  joined.velocity_m_per_s = joined.slope_m_per_s;
  if (!before.albedo.empty() && !after.albedo.empty()) join_albedos(before, after, u, joined);
  if (!before.attitude_object.empty()) join_attitudes(before, after, u, span_s, joined);
  return joined;
}

double cubic_error_m(const std::array<const ObjectStates*, 3>& three, std::size_t i) {
  const auto& [first, middle, last] = three;
  if (first->code[i] || middle->code[i] || last->code[i])
    return std::numeric_limits<double>::infinity();
  const double span_s = (last->time - first->time).seconds();
  const Vec<Gcrs> cubic = interpolate_cubic(0.5, span_s, first->position(i), first->slope(i),
                                            last->position(i), last->slope(i));
  const double smooth_m = norm(cubic - middle->position(i)) / 16.0;
  // A jump of the velocity at the middle is twice what the cubic's slope is off there, and bends
  // the interval before it by 4/27 of the way that it makes in one step.
  const Vec<Gcrs> slope = (last->position(i) - first->position(i)) * (1.5 / span_s) -
                          (first->slope(i) + last->slope(i)) * 0.25;
  const double jump_m_per_s = 2.0 * norm(slope - middle->slope(i));
  return std::max(smooth_m, 4.0 / 27.0 * jump_m_per_s * 0.5 * span_s);
}

}  // namespace dmise
