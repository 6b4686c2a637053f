#include "core/orbit/attitude_interpolation.h"

#include <algorithm>
#include <cmath>

namespace dmise {

namespace {

Quaternion normalised(const Quaternion& q) {
  double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (q.w < 0) length = -length;
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

/// Quaternion of the rotation by |v| about v.
Quaternion rotation_by(const Vec<Gcrs>& v) {
  const double angle_rad = norm(v);
  const double s = angle_rad > 1e-12 ? std::sin(angle_rad / 2) / angle_rad : 0.5;
  return {std::cos(angle_rad / 2), v.x * s, v.y * s, v.z * s};
}

/// Inverse of `rotation_by`, with |v| <= pi.
Vec<Gcrs> rotation_vector(const Quaternion& any) {
  const Quaternion q = normalised(any);
  const Vec<Gcrs> v{q.x, q.y, q.z};
  const double sine = norm(v);
  return v * (sine > 1e-12 ? 2 * std::atan2(sine, q.w) / sine : 2.0);
}

Vec<Gcrs> rotated(const Quaternion& q, const Vec<Gcrs>& v) {
  const Vec<Gcrs> axis{q.x, q.y, q.z};
  const Vec<Gcrs> t = 2.0 * cross(axis, v);
  return v + q.w * t + cross(axis, t);
}

/// Derivative of the rotation vector `v` for an angular velocity `rate`.
Vec<Gcrs> rotation_vector_rate(const Vec<Gcrs>& v, const Vec<Gcrs>& rate) {
  const double a = norm(v);
  const double c = a > 1e-4 ? (1 - a / 2 / std::tan(a / 2)) / (a * a) : 1.0 / 12;
  return rate - 0.5 * cross(v, rate) + c * cross(v, cross(v, rate));
}

}  // namespace

AttitudeState attitude_state(const Attitude& attitude, const AttitudeScene& before,
                             const AttitudeScene& now, const AttitudeScene& after) {
  const Rotation<Gcrs, Body> r = gcrs_from_body(attitude, now);
  AttitudeState state{.gcrs_from_body = normalised(quaternion_of(r))};
  if (const auto* spin = std::get_if<SpinningAttitude>(&attitude)) {
    state.rate_rad_per_s = r * (unit(spin->axis) * spin->rate_rad_per_s);
  } else if (const auto* tumbling = std::get_if<TumblingAttitude>(&attitude)) {
    state.rate_rad_per_s = r * tumbling->rotation.rate_rad_per_s(now.time_s);
  } else if (after.time_s > before.time_s) {
    const Quaternion moved = quaternion_of(gcrs_from_body(attitude, after)) *
                             conjugate(quaternion_of(gcrs_from_body(attitude, before)));
    state.rate_rad_per_s = rotation_vector(moved) / (after.time_s - before.time_s);
  }
  return state;
}

Quaternion interpolate_attitude(double u, double tick_s, const AttitudeState& start,
                                const AttitudeState& end) {
  const Quaternion steady = rotation_by(start.rate_rad_per_s * tick_s) * start.gcrs_from_body;
  const Quaternion left_over = end.gcrs_from_body * conjugate(steady);
  const Vec<Gcrs> rest = rotation_vector(left_over);
  const Vec<Gcrs> rest_slope =
      rotation_vector_rate(rest, end.rate_rad_per_s - rotated(left_over, start.rate_rad_per_s));
  const Vec<Gcrs> part = rest * (u * u * (3 - 2 * u)) + rest_slope * (u * u * (u - 1) * tick_s);
  return normalised(rotation_by(part) *
                    (rotation_by(start.rate_rad_per_s * (u * tick_s)) * start.gcrs_from_body));
}

double worst_interpolation_rad(const TumblingAttitude& attitude, double tick_s, int ticks) {
  const auto state = [&](double time_s) {
    const AttitudeScene scene{.time_s = time_s};
    return attitude_state(attitude, scene, scene, scene);
  };
  const double period_s = attitude.rotation.rate_period_s();
  const double step_s = std::isfinite(period_s) ? period_s / ticks : tick_s;
  double worst_rad = 0.0;
  for (int k = 0; k < ticks; ++k) {
    const double start_s = k * step_s;
    const Quaternion between =
        interpolate_attitude(0.5, tick_s, state(start_s), state(start_s + tick_s));
    const Quaternion off = between * conjugate(state(start_s + tick_s / 2).gcrs_from_body);
    worst_rad = std::max(worst_rad, norm(rotation_vector(off)));
  }
  return worst_rad;
}

}  // namespace dmise
