#include "core/conjunction/encounter.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double min_sigma_m = 1e-3;
constexpr double reach_sigmas = 9.0;  // beyond which the density is below 1e-18
constexpr int intervals = 2000;       // for Simpson's rule

struct Line {
  Eigen::Vector3d position_m, velocity_m_per_s;
};

Line line_between(const Encounter& e) {
  return {eigen_of(e.second.state.position_m - e.first.state.position_m),
          eigen_of(e.second.state.velocity_m_per_s - e.first.state.velocity_m_per_s)};
}

/// Share of a normal distribution about `mean` within +- `half`, also where it is tiny.
double within(double mean, double sigma, double half) {
  const double scale = 1 / (std::sqrt(2.0) * sigma), off = std::fabs(mean);
  return 0.5 * (std::erfc((off - half) * scale) - std::erfc((off + half) * scale));
}

/// Integral over a disc about the origin of a normal distribution with axes x and y.
double over_disc(const Eigen::Vector2d& mean, const Eigen::Vector2d& sigma, double radius) {
  const double low = std::max(-radius, mean[0] - reach_sigmas * sigma[0]);
  const double high = std::min(radius, mean[0] + reach_sigmas * sigma[0]);
  if (low >= high) return 0.0;
  // x = radius sin(angle): no slope is infinite at the rim.
  const double first = std::asin(low / radius), last = std::asin(high / radius);
  const auto density = [&](double angle) {
    const double x = radius * std::sin(angle), half = radius * std::cos(angle);
    const double off = (x - mean[0]) / sigma[0];
    return std::exp(-0.5 * off * off) * within(mean[1], sigma[1], half) * half;
  };
  double sum = density(first) + density(last);
  for (int i = 1; i < intervals; ++i)
    sum += (i % 2 ? 4 : 2) * density(first + (last - first) * i / intervals);
  return sum * (last - first) / (3 * intervals) / (sigma[0] * std::sqrt(2 * pi));
}

}  // namespace

RelativeMotion relative_motion(const Encounter& encounter) {
  const Line line = line_between(encounter);
  const Eigen::Matrix3d axes = orbit_axes(encounter.first.state);
  const Eigen::Vector3d r = axes.transpose() * line.position_m;
  const Eigen::Vector3d v = axes.transpose() * line.velocity_m_per_s;
  return {{r[0], r[1], r[2]}, {v[0], v[1], v[2]}};
}

double to_closest_s(const Encounter& encounter) {
  const Line line = line_between(encounter);
  const double speed2 = line.velocity_m_per_s.squaredNorm();
  return speed2 > 0 ? -line.position_m.dot(line.velocity_m_per_s) / speed2 : 0.0;
}

double collision_probability(const Eigen::Vector3d& position_m,
                             const Eigen::Vector3d& velocity_m_per_s,
                             const Eigen::Matrix3d& covariance_m2, double radius_m) {
  const double speed = velocity_m_per_s.norm();
  if (!(speed > 0) || !(radius_m > 0)) return 0.0;
  const Eigen::Vector3d along = velocity_m_per_s / speed;
  const Eigen::Vector3d across = along.unitOrthogonal();
  Eigen::Matrix<double, 2, 3> plane;
  plane << across.transpose(), along.cross(across).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(plane * covariance_m2 *
                                                            plane.transpose());
  const Eigen::Vector2d mean = axes.eigenvectors().transpose() * (plane * position_m);
  const Eigen::Vector2d sigma = axes.eigenvalues().cwiseMax(min_sigma_m * min_sigma_m).cwiseSqrt();
  return std::clamp(over_disc(mean, sigma, radius_m), 0.0, 1.0);
}

double collision_probability(const Encounter& encounter) {
  const Line line = line_between(encounter);
  const Eigen::Matrix3d both = encounter.first.covariance.topLeftCorner<3, 3>() +
                               encounter.second.covariance.topLeftCorner<3, 3>();
  return collision_probability(line.position_m, line.velocity_m_per_s, both, encounter.radius_m);
}

}  // namespace dmise
