#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "core/tracking/integrate.h"
#include "core/tracking/line_of_light.h"
#include "core/tracking/orbit_state.h"
#include "core/tracking/predict.h"
#include "core/tracking/triangle.h"

namespace dmise {

/// Rows of a state that are estimated, out of all eight: 6, 7 or 8.
struct EstimatedRows {
  std::array<int, orbit_size> rows{0, 1, 2, 3, 4, 5, 6, 7};
  int count = 6;
};

/// A Gaussian: its mean, and a root S of its covariance S S' over the estimated rows. S is lower
/// triangular; only the upper left part is used.
struct RootGaussian {
  OrbitState mean;
  OrbitMatrix root = OrbitMatrix::Zero();
};

/// Steps of the square-root unscented filter for `N` estimated rows. With the weight 1 / (N + 1) of
/// the middle, all weights are positive: each root is the triangle of one QR decomposition, none
/// is ever subtracted from another. No heap.
template <int N>
class SigmaPoints {
 public:
  static constexpr int count = 2 * N + 1;
  static constexpr double weight = 0.5 / (N + 1), middle_weight = 1.0 / (N + 1);
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  SigmaPoints(const EstimatedRows& rows, const RootGaussian& gaussian)
      : rows_(rows), time_(gaussian.mean.time) {
    const OrbitVector mean = vector_of(gaussian.mean);
    const double spread = std::sqrt(N + 1.0);
    for (int k = 0; k < count; ++k) points_.col(k) = mean;
    for (int j = 0; j < N; ++j)
      for (int i = j; i < N; ++i) {
        const double d = spread * gaussian.root(i, j);
        points_(rows_.rows[std::size_t(i)], 1 + j) += d;
        points_(rows_.rows[std::size_t(i)], 1 + N + j) -= d;
      }
  }

  /// Propagates all points to `to` with the steps of the middle one. Returns the reason if a point
  /// has no path, else an empty text.
  std::string_view move(const ForceModel& forces, SimTime to, const PropagationSettings& settings,
                        std::vector<double>& steps) {
    steps.clear();
    for (int k = 0; k < count; ++k) {
      Path<double> path = path_of(k);
      const ForceSettings acting = acting_on(forces.settings(), path, false, false);
      const std::string_view reason =
          k == 0 ? integrate(forces, acting, time_, (to - time_).seconds(), settings, path, &steps)
                 : follow(forces, acting, time_, steps, path);
      if (!reason.empty()) return reason;
      points_.template block<6, 1>(0, k) << path.r.x, path.r.y, path.r.z, path.v.x, path.v.y,
          path.v.z;
    }
    time_ = to;
    return {};
  }

  /// Mean and root, with the process noise L L' of `noise` added.
  RootGaussian gaussian(const OrbitMatrix& noise) const {
    const OrbitVector mean = mean_of_points();
    Eigen::Matrix<double, count + N, N> stack;
    for (int i = 0; i < N; ++i) {
      const int row = rows_.rows[std::size_t(i)];
      stack(0, i) = std::sqrt(middle_weight) * (points_(row, 0) - mean[row]);
      for (int k = 1; k < count; ++k)
        stack(k, i) = std::sqrt(weight) * (points_(row, k) - mean[row]);
      for (int j = 0; j < N; ++j) stack(count + j, i) = noise(row, rows_.rows[std::size_t(j)]);
    }
    RootGaussian out{state_of(mean, time_)};
    out.root.template topLeftCorner<N, N>() = triangle<count + N, N>(stack);
    return out;
  }

  /// The predicted direction with its covariance, and what `updated` needs of the points.
  struct Seen {
    PredictedDirection direction;
    std::array<Eigen::Vector2d, std::size_t(count)> angles;  // about `direction`
    OrbitVector mean;
  };
  Seen see(const Vec<Gcrs>& sensor_m) const {
    Seen out;
    const Eigen::Vector3d sensor = eigen_of(sensor_m);
    std::array<Vec<Gcrs>, std::size_t(count)> directions;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Vec<Gcrs> middle;
    for (int k = 0; k < count; ++k) {
      const LineOfLight line = line_of_light(points_.template block<3, 1>(0, k),
                                             points_.template block<3, 1>(3, k), sensor);
      directions[std::size_t(k)] = gcrs_of(line.line_m / std::max(line.range_m, 1e-9));
      if (k == 0) {
        middle = directions[0];
        const Eigen::Vector3d towards = eigen_of(middle);
        out.direction.range_m = line.range_m;
        out.direction.range_rate_m_per_s = towards.dot(line.velocity_m_per_s);
        out.direction.rate_rad_per_s = gcrs_of(
            (line.velocity_m_per_s - out.direction.range_rate_m_per_s * towards) / line.range_m);
      }
      out.angles[std::size_t(k)] = angles_between(middle, directions[std::size_t(k)]);
      mean += (k == 0 ? middle_weight : weight) * out.angles[std::size_t(k)];
    }
    const SkyTangents tangents = sky_tangents(middle);
    out.direction.time = time_;
    out.direction.direction =
        unit(middle + std::tan(mean[0]) * tangents.east + std::tan(mean[1]) * tangents.north);
    for (int k = 0; k < count; ++k) {
      Eigen::Vector2d& angles = out.angles[std::size_t(k)];
      angles -= mean;
      out.direction.covariance_rad2 +=
          (k == 0 ? middle_weight : weight) * angles * angles.transpose();
    }
    out.mean = mean_of_points();
    return out;
  }

  /// The Gaussian after an observation, by the triangle of the joint root [R 0; A X]: its first
  /// rows are the root of the innovation's covariance, the last that of what remains.
  RootGaussian updated(const Seen& seen, const AngleObservation& observation,
                       const Eigen::Vector2d& residual_rad) const {
    constexpr int width = N + 2;
    Eigen::Matrix<double, count + 2, width> stack;
    stack.template bottomRows<2>().setZero();
    const auto& c = observation.covariance_rad2;
    const double east = std::sqrt(c[0]), both = c[1] / east;
    stack(count, 0) = east;
    stack(count, 1) = both;
    stack(count + 1, 1) = std::sqrt(std::max(0.0, c[2] - both * both));
    for (int k = 0; k < count; ++k) {
      const double root = std::sqrt(k == 0 ? middle_weight : weight);
      stack(k, 0) = root * seen.angles[std::size_t(k)][0];
      stack(k, 1) = root * seen.angles[std::size_t(k)][1];
      for (int i = 0; i < N; ++i) {
        const int row = rows_.rows[std::size_t(i)];
        stack(k, 2 + i) = root * (points_(row, k) - seen.mean[row]);
      }
    }
    const Eigen::Matrix<double, width, width> joint = triangle<count + 2, width>(stack);
    // joint is lower triangular: [Z 0; G X], S = Z Z', gain = G Z^-1.
    const double u = residual_rad[0] / joint(0, 0);
    const double v = (residual_rad[1] - joint(1, 0) * u) / joint(1, 1);
    OrbitVector mean = seen.mean;
    for (int i = 0; i < N; ++i)
      mean[rows_.rows[std::size_t(i)]] += joint(2 + i, 0) * u + joint(2 + i, 1) * v;
    RootGaussian out{state_of(mean, time_)};
    out.root.template topLeftCorner<N, N>() = joint.template bottomRightCorner<N, N>();
    return out;
  }

  /// The Gaussian after a number was measured that `of` has of position, velocity and time. Nothing
  /// if it is more than `gate_sigmas` from what is expected.
  template <class NumberOf>
  std::optional<RootGaussian> updated(const NumberOf& of, const MeasuredNumber& measured,
                                      double gate_sigmas) const {
    std::array<double, std::size_t(count)> numbers;
    double mean_number = 0.0;
    for (int k = 0; k < count; ++k) {
      double& number = numbers[std::size_t(k)];
      number = of(points_.template block<3, 1>(0, k), points_.template block<3, 1>(3, k));
      mean_number += (k == 0 ? middle_weight : weight) * number;
    }
    const OrbitVector points_mean = mean_of_points();
    constexpr int width = N + 1;
    Eigen::Matrix<double, count + 1, width> stack;
    stack.template bottomRows<1>().setZero();
    stack(count, 0) = measured.sigma;
    for (int k = 0; k < count; ++k) {
      const double root = std::sqrt(k == 0 ? middle_weight : weight);
      stack(k, 0) = root * (numbers[std::size_t(k)] - mean_number);
      for (int i = 0; i < N; ++i) {
        const int row = rows_.rows[std::size_t(i)];
        stack(k, 1 + i) = root * (points_(row, k) - points_mean[row]);
      }
    }
    const Eigen::Matrix<double, width, width> joint = triangle<count + 1, width>(stack);
    const double sigmas = (measured.value - mean_number) / joint(0, 0);
    if (!(std::fabs(sigmas) <= gate_sigmas)) return std::nullopt;
    OrbitVector mean = points_mean;
    for (int i = 0; i < N; ++i) mean[rows_.rows[std::size_t(i)]] += joint(1 + i, 0) * sigmas;
    RootGaussian out{state_of(mean, time_)};
    out.root.template topLeftCorner<N, N>() = joint.template bottomRightCorner<N, N>();
    return out;
  }

 private:
  /// Lower triangle T with T T' = stack' stack.
  template <int Rows, int Columns>
  static Eigen::Matrix<double, Columns, Columns> triangle(
      Eigen::Matrix<double, Rows, Columns>& stack) {
    triangularise<Columns>(stack);
    return stack.template topRows<Columns>().transpose();
  }

  Path<double> path_of(int k) const {
    const auto x = points_.col(k);
    return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}, x[drag_row], x[srp_row]};
  }

  static std::string_view follow(const ForceModel& forces, const ForceSettings& acting,
                                 SimTime start, const std::vector<double>& steps,
                                 Path<double>& path) {
    Path<double> next;
    Triple<double> slope, end;
    double done_s = 0;
    bool first = true;
    for (const double h : steps) {
      const ForceInputs around = forces.surroundings(start + sim_seconds(done_s + h / 2));
      if (first) slope = acceleration(acting, around, path.r, path.v, path.drag, path.srp);
      step(acting, around, path, h, slope, next, end);
      path = next;
      slope = end;
      first = false;
      done_s += h;
    }
    const double r2 = path.r.x * path.r.x + path.r.y * path.r.y + path.r.z * path.r.z;
    if (!std::isfinite(r2)) return "the path is not finite";
    if (r2 < ground_m * ground_m) return "the path enters the Earth";
    return {};
  }

  OrbitVector mean_of_points() const {
    OrbitVector sum = OrbitVector::Zero();
    for (int k = 1; k < count; ++k) sum += points_.col(k) - points_.col(0);
    return points_.col(0) + weight * sum;
  }

  EstimatedRows rows_;
  SimTime time_;
  Eigen::Matrix<double, orbit_size, count> points_;
};

}  // namespace dmise
