#pragma once
#include <Eigen/Core>

#include "core/base/units.h"
#include "core/orbit/two_body.h"
#include "core/tracking/angle_observation.h"
#include "core/tracking/orbit_state.h"

namespace dmise {

/// From a sensor to where an object was when its light left.
struct LineOfLight {
  Eigen::Vector3d line_m;            // from the sensor
  Eigen::Vector3d velocity_m_per_s;  // the object's then
  double range_m = 0.0;
  double light_time_s = 0.0;
};

/// For an object at `position_m` at the time of reception. Within a light time it moves with its
/// velocity and the attraction of the Earth's centre: exact to 1e-6 m within the Moon's distance.
inline LineOfLight line_of_light(const Eigen::Vector3d& position_m,
                                 const Eigen::Vector3d& velocity_m_per_s,
                                 const Eigen::Vector3d& sensor_m) {
  const double r2 = position_m.squaredNorm();
  const Eigen::Vector3d pull = -earth_gm_m3_per_s2 / (r2 * std::sqrt(r2)) * position_m;
  const Eigen::Vector3d now_m = position_m - sensor_m;
  LineOfLight out{now_m, velocity_m_per_s};
  // Each iteration reduces the error by a factor v/c.
  for (int i = 0; i < 3; ++i) {
    const double t = out.line_m.norm() / speed_of_light_m_per_s;
    out.light_time_s = t;
    out.line_m = now_m - t * velocity_m_per_s + (0.5 * t * t) * pull;
  }
  out.velocity_m_per_s = velocity_m_per_s - out.light_time_s * pull;
  out.range_m = out.line_m.norm();
  return out;
}

/// Derivative of the range by the time of reception, for a sensor with this velocity.
inline double range_rate_m_per_s(const LineOfLight& line, const Eigen::Vector3d& sensor_m_per_s) {
  const Eigen::Vector3d towards = line.line_m / line.range_m;
  return towards.dot(line.velocity_m_per_s - sensor_m_per_s) /
         (1 + towards.dot(line.velocity_m_per_s) / speed_of_light_m_per_s);
}

/// Position `dt_s` after a state, by its velocity and the attraction of the Earth's centre: for
/// some seconds.
inline Vec<Gcrs> position_after_m(const Vec<Gcrs>& r, const Vec<Gcrs>& v, double dt_s) {
  const double r2 = dot(r, r);
  return r + v * dt_s - r * (earth_gm_m3_per_s2 / (r2 * std::sqrt(r2)) * dt_s * dt_s / 2);
}

/// East and north as the rows of a matrix.
inline Eigen::Matrix<double, 2, 3> rows_of(const SkyTangents& tangents) {
  Eigen::Matrix<double, 2, 3> rows;
  rows << eigen_of(tangents.east).transpose(), eigen_of(tangents.north).transpose();
  return rows;
}

/// Derivatives of the direction's angles, along `east` and `north` at it, with respect to position
/// and velocity at the time of reception.
inline Eigen::Matrix<double, 2, 6> angle_derivatives(const LineOfLight& line,
                                                     const SkyTangents& tangents) {
  const Eigen::Vector3d towards = line.line_m / line.range_m;
  // A longer line is older: d line = d r - t d v - v (towards . d line) / c.
  const Eigen::Matrix3d delay = Eigen::Matrix3d::Identity() -
                                line.velocity_m_per_s * towards.transpose() /
                                    (speed_of_light_m_per_s + towards.dot(line.velocity_m_per_s));
  const Eigen::Matrix<double, 2, 3> place = rows_of(tangents) * delay / line.range_m;
  Eigen::Matrix<double, 2, 6> out;
  out << place, -line.light_time_s * place;
  return out;
}

}  // namespace dmise
