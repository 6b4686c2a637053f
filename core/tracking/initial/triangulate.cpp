#include "core/tracking/initial/triangulate.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/numeric/chi_square.h"
#include "core/base/units.h"
#include "core/orbit/two_body.h"
#include "core/tracking/line_of_light.h"
#include "core/tracking/orbit_state.h"

namespace dmise {

namespace {

using Meeting = Outcome<TriangulatedPosition>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// The point nearest to all lines, each with the same weight.
Eigen::Vector3d nearest_point(std::span<const AngleObservation> lines) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const AngleObservation& line : lines) {
    const Eigen::Vector3d u = eigen_of(line.direction);
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - u * u.transpose();
    sum += across;
    right += across * eigen_of(line.sensor_m);
  }
  return sum.ldlt().solve(right);
}

double widest_angle(std::span<const AngleObservation> lines) {
  double widest = 0;
  for (const AngleObservation& a : lines)
    for (const AngleObservation& b : lines) {
      const double angle = angle_rad(a.direction, b.direction);
      widest = std::max(widest, std::min(angle, pi - angle));
    }
  return widest;
}

/// Inverse covariance of the velocity of what moves at `position_m`, if nothing is known of it:
/// that of a circular orbit in any direction across the radius, a fifth of its speed along it.
Eigen::Matrix3d velocity_weight(const Eigen::Vector3d& position_m) {
  const double v2 = earth_gm_m3_per_s2 / position_m.norm();
  const Eigen::Vector3d up = position_m.normalized();
  const Eigen::Matrix3d radial = up * up.transpose();
  return radial / (0.04 * v2) + (Eigen::Matrix3d::Identity() - radial) / (0.5 * v2);
}

/// Normal equations of position and velocity at the common time.
struct MeetingNormal {
  Matrix6 matrix = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  double chi2 = 0;
};

MeetingNormal meeting_normal(std::span<const AngleObservation> lines, SimTime middle,
                             double light_s, const Eigen::Vector3d& r, const Eigen::Vector3d& v) {
  MeetingNormal out;
  const double r2 = r.squaredNorm();
  const Eigen::Vector3d pull = -earth_gm_m3_per_s2 / (r2 * std::sqrt(r2)) * r;
  for (const AngleObservation& seen : lines) {
    const Eigen::Vector3d sensor = eigen_of(seen.sensor_m);
    double dt_s = 0;
    Eigen::Vector3d line = r - sensor;
    for (int i = 0; i < 3; ++i) {
      dt_s = (seen.time - middle).seconds() + light_s - line.norm() / speed_of_light_m_per_s;
      line = r + dt_s * v + 0.5 * dt_s * dt_s * pull - sensor;
    }
    const double range_m = line.norm();
    const Vec<Gcrs> direction = gcrs_of(line / range_m);
    const Eigen::Vector2d residual = angles_between(direction, seen.direction);
    const Eigen::Matrix<double, 2, 3> sky = rows_of(sky_tangents(direction));
    Eigen::Matrix<double, 2, 6> h;
    h << sky / range_m, dt_s * sky / range_m;
    const Eigen::Matrix2d weight = covariance_of(seen).inverse();
    out.matrix += h.transpose() * weight * h;
    out.right += h.transpose() * weight * residual;
    out.chi2 += residual.dot(weight * residual);
  }
  return out;
}

/// Probability that chi-square of `degrees` degrees of freedom is above `chi2`: good to a factor of
/// 2 down to 1e-8.
double tail(double chi2, int degrees) {
  return 0.5 * std::erfc(normal_of_chi_square(chi2, degrees) / std::sqrt(2.0));
}

}  // namespace

Outcome<TriangulatedPosition> triangulate(std::span<const AngleObservation> lines,
                                          const Vec<Gcrs>& velocity_m_per_s,
                                          const TriangulationSettings& settings) {
  if (lines.size() < 2) return Meeting::refused("fewer than two lines of sight");
  SimTime first = lines[0].time, last = first;
  for (const AngleObservation& line : lines) {
    if (const auto fault = fault_of(line); !fault.empty()) return Meeting::refused(fault);
    first = std::min(first, line.time);
    last = std::max(last, line.time);
  }
  if ((last - first).seconds() > settings.longest_s)
    return Meeting::refused("the lines of sight are too far apart in time");
  TriangulatedPosition out;
  out.angle_rad = widest_angle(lines);
  if (!(out.angle_rad >= settings.min_angle_rad))
    return Meeting::refused("the lines of sight are nearly parallel");

  const Eigen::Vector3d start = nearest_point(lines);
  if (!start.allFinite()) return Meeting::refused("the lines of sight do not meet");
  const SimTime middle{first.ns + (last.ns - first.ns) / 2};
  double range_m = 0;
  for (const AngleObservation& line : lines) {
    const double along = (start - eigen_of(line.sensor_m)).dot(eigen_of(line.direction));
    if (!(along > 0)) return Meeting::refused("the lines of sight meet behind a sensor");
    range_m += along / double(lines.size());
  }
  const double light_s = range_m / speed_of_light_m_per_s;
  Eigen::Vector3d r = start, v = eigen_of(velocity_m_per_s);
  const bool known = norm(velocity_m_per_s) > 0;
  const auto in_range = [&] {
    return r.allFinite() && r.norm() >= settings.min_distance_m &&
           r.norm() <= settings.largest_distance_m;
  };
  if (!in_range()) return Meeting::refused("the lines of sight meet at no height of an orbit");
  Matrix6 covariance = Matrix6::Zero();
  for (int i = 0; i < 20; ++i) {
    MeetingNormal normal = meeting_normal(lines, middle, light_s, r, v);
    const Eigen::Vector3d before = r;
    if (known) {
      const Eigen::LDLT<Eigen::Matrix3d> root(normal.matrix.topLeftCorner<3, 3>());
      r += root.solve(normal.right.head<3>());
      covariance.topLeftCorner<3, 3>() = root.solve(Eigen::Matrix3d::Identity());
    } else {
      const Eigen::Matrix3d weight = velocity_weight(r);
      normal.matrix.bottomRightCorner<3, 3>() += weight;
      normal.right.tail<3>() -= weight * v;
      const Vector6 scale = normal.matrix.diagonal().cwiseSqrt().cwiseInverse();
      const Eigen::LDLT<Matrix6> root(scale.asDiagonal() * normal.matrix * scale.asDiagonal());
      const Vector6 change = scale.cwiseProduct(root.solve(scale.cwiseProduct(normal.right)));
      r += change.head<3>();
      v += change.tail<3>();
      covariance = scale.asDiagonal() * root.solve(Matrix6::Identity()) * scale.asDiagonal();
    }
    if (!in_range()) return Meeting::refused("the lines of sight meet at no height of an orbit");
    if ((r - before).norm() < 1e-6 * std::sqrt(covariance.topLeftCorner<3, 3>().trace()) + 1e-6)
      break;
  }
  const MeetingNormal end = meeting_normal(lines, middle, light_s, r, v);
  out.chi2 = end.chi2;
  if (!known) out.chi2 += (v.transpose() * velocity_weight(r) * v).value();
  for (const AngleObservation& line : lines)
    if (!((r - eigen_of(line.sensor_m)).dot(eigen_of(line.direction)) > 0))
      return Meeting::refused("the lines of sight meet behind a sensor");
  out.time = middle - sim_seconds(light_s);
  out.position_m = gcrs_of(r);
  out.covariance_m2 = covariance.topLeftCorner<3, 3>();
  out.degrees_of_freedom = 2 * int(lines.size()) - 3;
  if (!out.covariance_m2.allFinite() || !(out.covariance_m2.diagonal().array() > 0).all())
    return Meeting::refused("the lines of sight do not determine a position");
  if (tail(end.chi2, out.degrees_of_freedom) < settings.min_probability)
    return Meeting::refused("the lines of sight miss each other");
  return out;
}

}  // namespace dmise
