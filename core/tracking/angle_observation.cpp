#include "core/tracking/angle_observation.h"

#include <algorithm>
#include <cmath>

namespace dmise {

namespace {

bool finite(const Vec<Gcrs>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

SkyTangents sky_tangents(const Vec<Gcrs>& direction) {
  const double across = std::hypot(direction.x, direction.y);
  const Vec<Gcrs> east =
      across > 0 ? Vec<Gcrs>{-direction.y / across, direction.x / across, 0} : Vec<Gcrs>{0, 1, 0};
  return {east, cross(direction, east)};
}

Eigen::Matrix2d covariance_of(const AngleObservation& observation) {
  const auto& c = observation.covariance_rad2;
  Eigen::Matrix2d out;
  out << c[0], c[1], c[1], c[2];
  return out;
}

double sigma_rad(const AngleObservation& observation) {
  return std::sqrt(std::max(observation.covariance_rad2[0], observation.covariance_rad2[2]));
}

double largest_sigma_rad(std::span<const AngleObservation> observations) {
  double largest = 0;
  for (const AngleObservation& o : observations) largest = std::max(largest, sigma_rad(o));
  return largest;
}

Eigen::Vector2d angles_between(const Vec<Gcrs>& from, const Vec<Gcrs>& to) {
  const SkyTangents tangents = sky_tangents(from);
  const double east = dot(to, tangents.east), north = dot(to, tangents.north);
  const double sine = std::hypot(east, north);
  const double angle = std::atan2(sine, dot(to, from));
  // Opposite directions have no tangent: any will do.
  if (sine == 0) return {angle, 0};
  return {angle * east / sine, angle * north / sine};
}

std::string_view fault_of(const AngleObservation& o) {
  // Differences of two times must be times.
  constexpr std::int64_t longest_ns = std::int64_t(1) << 61;
  if (o.time.ns > longest_ns || o.time.ns < -longest_ns) return "the time is out of range";
  if (!finite(o.sensor_m) || norm(o.sensor_m) > 1e12) return "the sensor's position is not known";
  if (!finite(o.direction) || std::fabs(norm(o.direction) - 1) > 1e-6)
    return "the direction is not a unit vector";
  const auto& [e, c, n] = o.covariance_rad2;
  if (!std::isfinite(e) || !std::isfinite(c) || !std::isfinite(n) || !(e > 0) || !(n > 0) ||
      !(e * n - c * c > 0))
    return "the covariance is not positive definite";
  for (const auto& along : {o.range_m, o.range_rate_m_per_s})
    if (along && !(std::isfinite(along->value) && std::isfinite(along->sigma) && along->sigma > 0))
      return "the range or its rate has no standard deviation";
  if (o.range_rate_m_per_s && !finite(o.sensor_m_per_s))
    return "the sensor's velocity is not known";
  return {};
}

Outcome<AngleObservation> angle_observation(const Detection& detection) {
  using Result = Outcome<AngleObservation>;
  AngleObservation out;
  out.time = detection.time;
  out.sensor_m = detection.sensor_position_m + detection.refraction_offset_m;
  out.direction = from_spherical<Gcrs>(detection.corrected_ra_rad, detection.corrected_dec_rad);
  out.covariance_rad2 = detection.covariance_rad2;
  out.sensor = detection.sensor;
  out.detection_id = detection.id;
  if (detection.range_m) out.range_m = {*detection.range_m, *detection.range_sigma_m};
  if (detection.range_rate_m_per_s)
    out.range_rate_m_per_s = {*detection.range_rate_m_per_s, *detection.range_rate_sigma_m_per_s};
  out.sensor_m_per_s = detection.sensor_velocity_m_per_s;
  const double offset_m = norm(detection.refraction_offset_m);
  if (!std::isfinite(offset_m)) return Result::refused("the offset of refraction is not finite");
  if (offset_m > 0) {
    // The assumed parallax is put back; its scatter was along the vertical.
    const Vec<Gcrs> upwards = detection.refraction_offset_m / offset_m;
    const SkyTangents tangents = sky_tangents(out.direction);
    const double variance =
        detection.refraction_parallax_sigma_rad * detection.refraction_parallax_sigma_rad;
    const double east = dot(tangents.east, upwards), north = dot(tangents.north, upwards);
    out.covariance_rad2[0] -= variance * east * east;
    out.covariance_rad2[1] -= variance * east * north;
    out.covariance_rad2[2] -= variance * north * north;
    out.direction = unit(out.direction - detection.refraction_parallax_rad * upwards);
  }
  if (const std::string_view fault = fault_of(out); !fault.empty()) return Result::refused(fault);
  return out;
}

}  // namespace dmise
