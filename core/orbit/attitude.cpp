#include "core/orbit/attitude.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {

namespace {

/// Part of `v` perpendicular to the unit vector `axis`.
template <class F>
Vec<F> perpendicular_part(const Vec<F>& axis, const Vec<F>& v) {
  return v - axis * dot(axis, v);
}

/// Returns a unit vector perpendicular to the unit vector `axis`: the projection of `wanted`, or of
/// the coordinate axis farthest from `axis` if that vanishes.
template <class F>
Vec<F> unit_perpendicular(const Vec<F>& axis, const Vec<F>& wanted) {
  const Vec<F> across = perpendicular_part(axis, wanted);
  if (norm(across) > 1e-12 * norm(wanted)) return unit(perpendicular_part(axis, unit(across)));
  const double ax = std::abs(axis.x), ay = std::abs(axis.y), az = std::abs(axis.z);
  const Vec<F> other = ax <= ay && ax <= az ? Vec<F>{1, 0, 0}
                       : ay <= az           ? Vec<F>{0, 1, 0}
                                            : Vec<F>{0, 0, 1};
  return unit(perpendicular_part(axis, other));
}

/// Rotation whose columns are the axes.
template <class To, class From>
Rotation<To, From> from_axes(const Vec<To>& x, const Vec<To>& y, const Vec<To>& z) {
  Rotation<To, From> r;
  r.m = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
  return r;
}

/// `v` rotated by `angle_rad` about the unit vector `axis` (Rodrigues).
template <class F>
Vec<F> rotated(const Vec<F>& v, const Vec<F>& axis, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

Vec<Gcrs> nadir_of(const AttitudeScene& scene) {
  const double r_m = norm(scene.position_m);
  if (!(r_m > 0)) throw Error("attitude: the object is at the Earth's centre");
  return scene.position_m / -r_m;
}

Rotation<Gcrs, Body> attitude_of(const NadirAttitude&, const AttitudeScene& scene) {
  const Vec<Gcrs> z = nadir_of(scene);
  const Vec<Gcrs> x = unit_perpendicular(z, scene.velocity_m_per_s);
  return from_axes<Gcrs, Body>(x, cross(z, x), z);
}

Rotation<Gcrs, Body> attitude_of(const SunYawAttitude&, const AttitudeScene& scene) {
  const Vec<Gcrs> z = nadir_of(scene);
  const Vec<Gcrs> to_sun = scene.sun_m - scene.position_m;
  const bool sun_at_zenith = norm(cross(z, to_sun)) <= 1e-12 * norm(to_sun);
  const Vec<Gcrs> x = unit_perpendicular(z, sun_at_zenith ? scene.velocity_m_per_s : to_sun);
  return from_axes<Gcrs, Body>(x, cross(z, x), z);
}

Rotation<Gcrs, Body> attitude_of(const InertialAttitude& attitude, const AttitudeScene&) {
  return attitude.gcrs_from_body;
}

Rotation<Gcrs, Body> attitude_of(const SpinningAttitude& attitude, const AttitudeScene& scene) {
  if (!(norm(attitude.axis) > 0)) throw Error("attitude: spin axis must not be zero");
  const Vec<Body> axis = unit(attitude.axis);
  const double angle_rad = std::remainder(attitude.rate_rad_per_s * scene.time_s, 2 * pi);
  return attitude.gcrs_from_body *
         from_axes<Body, Body>(rotated(Vec<Body>{1, 0, 0}, axis, angle_rad),
                               rotated(Vec<Body>{0, 1, 0}, axis, angle_rad),
                               rotated(Vec<Body>{0, 0, 1}, axis, angle_rad));
}

Rotation<Gcrs, Body> attitude_of(const TumblingAttitude& attitude, const AttitudeScene& scene) {
  return attitude.gcrs_from_body *
         rotation_of<Body, Body>(attitude.rotation.first_from_now(scene.time_s));
}

Quaternion between(const Quaternion& a, Quaternion b, double u) {
  double cosine = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
  if (cosine < 0) {  // q and -q are one attitude: take the short way
    b = {-b.w, -b.x, -b.y, -b.z};
    cosine = -cosine;
  }
  const double angle = std::acos(std::min(1.0, cosine)), sine = std::sin(angle);
  const double wa = sine > 1e-9 ? std::sin((1 - u) * angle) / sine : 1 - u;
  const double wb = sine > 1e-9 ? std::sin(u * angle) / sine : u;
  return {wa * a.w + wb * b.w, wa * a.x + wb * b.x, wa * a.y + wb * b.y, wa * a.z + wb * b.z};
}

Rotation<Gcrs, Body> attitude_of(const TableAttitude& table, const AttitudeScene& scene) {
  const auto& times = table.time_s;
  if (times.empty() || times.size() != table.gcrs_from_body.size())
    throw Error("attitude: a table needs one quaternion for each time");
  if (!(scene.time_s >= times.front() && scene.time_s <= times.back()))
    throw Error("attitude: no attitude at " + std::to_string(scene.time_s) +
                " s; the table spans " + std::to_string(times.front()) + " to " +
                std::to_string(times.back()) + " s");
  const auto after = std::upper_bound(times.begin(), times.end(), scene.time_s);
  if (after == times.end()) return rotation_of<Gcrs, Body>(table.gcrs_from_body.back());
  const std::size_t i = static_cast<std::size_t>(after - times.begin()) - 1;
  const double u = (scene.time_s - times[i]) / (times[i + 1] - times[i]);
  return rotation_of<Gcrs, Body>(between(table.gcrs_from_body[i], table.gcrs_from_body[i + 1], u));
}

Rotation<Gcrs, Body> attitude_of(const NodeAttitude& attitude, const AttitudeScene&) {
  throw Error("attitude: only node " + attitude.node + " knows how its objects are turned");
}

}  // namespace

Rotation<Gcrs, Body> gcrs_from_body(const Attitude& attitude, const AttitudeScene& scene) {
  return std::visit([&](const auto& model) { return attitude_of(model, scene); }, attitude);
}

double panel_angle_rad(const SunTrackingPanel& panel, const Vec<Body>& sun_direction) {
  if (!(norm(panel.hinge) > 0)) throw Error("attitude: a panel's hinge must not be zero");
  const Vec<Body> hinge = unit(panel.hinge);
  const Vec<Body> normal = unit_perpendicular(hinge, panel.normal);
  const Vec<Body> across = perpendicular_part(hinge, sun_direction);
  if (norm(across) <= 1e-12 * norm(sun_direction)) return 0.0;
  return std::atan2(dot(cross(hinge, normal), across), dot(normal, across));
}

Rotation<Body, Panel> body_from_panel(const SunTrackingPanel& panel,
                                      const Vec<Body>& sun_direction) {
  const double angle_rad = panel_angle_rad(panel, sun_direction);
  const Vec<Body> hinge = unit(panel.hinge);
  const Vec<Body> normal = rotated(unit_perpendicular(hinge, panel.normal), hinge, angle_rad);
  return from_axes<Body, Panel>(hinge, cross(normal, hinge), normal);
}

}  // namespace dmise
