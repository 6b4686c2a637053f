#include "core/tracking/predict.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "core/base/algebra/symmetric2.h"
#include "core/base/error.h"
#include "core/tracking/line_of_light.h"

namespace dmise {

PredictedDirection predict_direction(const OrbitEstimate& estimate, const Vec<Gcrs>& sensor_m,
                                     SimTime time) {
  PredictedDirection out;
  out.time = time;
  const double dt_s = (time - estimate.state.time).seconds();
  TwoBodyState now{estimate.state.position_m, estimate.state.velocity_m_per_s};
  if (dt_s != 0) now = propagate_two_body(now, dt_s);
  const LineOfLight line =
      line_of_light(eigen_of(now.position_m), eigen_of(now.velocity_m_per_s), eigen_of(sensor_m));
  if (!(line.range_m > 0)) throw Error("the object is at the sensor: it has no direction");
  const Eigen::Vector3d towards = line.line_m / line.range_m;
  out.direction = gcrs_of(towards);
  out.range_m = line.range_m;
  out.range_rate_m_per_s = towards.dot(line.velocity_m_per_s);
  out.rate_rad_per_s =
      gcrs_of((line.velocity_m_per_s - out.range_rate_m_per_s * towards) / line.range_m);
  // In a few seconds positions move with their velocities.
  Eigen::Matrix<double, 2, 6> h = angle_derivatives(line, sky_tangents(out.direction));
  h.rightCols<3>() += dt_s * h.leftCols<3>();
  out.covariance_rad2 = h * estimate.covariance.topLeftCorner<6, 6>() * h.transpose();
  return out;
}

Innovation innovation_of(const PredictedDirection& predicted, const AngleObservation& observed) {
  Innovation out;
  out.residual_rad = angles_between(predicted.direction, observed.direction);
  out.covariance_rad2 = predicted.covariance_rad2 + covariance_of(observed);
  const Symmetric2 covariance{out.covariance_rad2(0, 0), out.covariance_rad2(0, 1),
                              out.covariance_rad2(1, 1)};
  const double square = determinant(covariance);
  out.d2 = mahalanobis2(covariance, out.residual_rad[0], out.residual_rad[1]);
  if (!(square > 0) || !std::isfinite(out.d2))
    out.d2 = std::numeric_limits<double>::max();  // a prediction without an error
  out.log_likelihood = -0.5 * out.d2 - std::log(2 * pi) - 0.5 * std::log(std::max(square, 1e-300));
  return out;
}

PredictedMotion predict_motion(const OrbitEstimate& estimate, const Vec<Gcrs>& sensor_m,
                               const Vec<Gcrs>& sensor_m_per_s, SimTime time) {
  PredictedMotion out{predict_direction(estimate, sensor_m, time), {}};
  const PredictedDirection& seen = out.direction;
  out.rate_rad_per_s =
      seen.rate_rad_per_s -
      (sensor_m_per_s - seen.direction * dot(sensor_m_per_s, seen.direction)) / seen.range_m;
  const Eigen::Vector3d towards = eigen_of(seen.direction);
  const double along_m_per_s = seen.range_rate_m_per_s - dot(sensor_m_per_s, seen.direction);
  const Eigen::Matrix<double, 2, 3> across = rows_of(sky_tangents(seen.direction)) / seen.range_m;
  // Rate = across (v - v_sensor), with `across` turning and shrinking as the place moves.
  Eigen::Matrix<double, 4, 6> h = Eigen::Matrix<double, 4, 6>::Zero();
  h.block<2, 3>(0, 0) = across;
  h.block<2, 3>(2, 0) =
      -(along_m_per_s * across +
        seen.range_m * across * eigen_of(out.rate_rad_per_s) * towards.transpose()) /
      seen.range_m;
  h.block<2, 3>(2, 3) = across;
  const double dt_s = (time - estimate.state.time).seconds();
  h.rightCols<3>() += dt_s * h.leftCols<3>();
  out.covariance = h * estimate.covariance.topLeftCorner<6, 6>() * h.transpose();
  return out;
}

MotionInnovation innovation_of(const PredictedMotion& predicted, const SeenMotion& observed) {
  MotionInnovation out;
  const Eigen::Matrix<double, 2, 3> axes = rows_of(sky_tangents(predicted.direction.direction));
  const Eigen::Vector3d expected = eigen_of(predicted.rate_rad_per_s);
  Eigen::Vector3d rate = eigen_of(observed.rate_rad_per_s);
  if (rate.dot(expected) < 0) rate = -rate;  // a streak does not tell which end came first
  out.residual << angles_between(predicted.direction.direction, observed.observation.direction),
      axes * (rate - expected);
  Eigen::Matrix4d covariance = predicted.covariance;
  covariance.topLeftCorner<2, 2>() += covariance_of(observed.observation);
  const double variance = observed.rate_sigma_rad_per_s * observed.rate_sigma_rad_per_s;
  covariance.bottomRightCorner<2, 2>() += variance * Eigen::Matrix2d::Identity();
  const Eigen::LLT<Eigen::Matrix4d> root(covariance);
  out.d2 = std::numeric_limits<double>::max();
  if (root.info() != Eigen::Success) return out;  // a prediction without an error
  const double d2 = out.residual.dot(root.solve(out.residual));
  if (!std::isfinite(d2)) return out;
  out.d2 = d2;
  out.spread = 4 * std::log(2 * pi) + 2 * root.matrixLLT().diagonal().array().log().sum();
  return out;
}

}  // namespace dmise
