#include "core/tracking/predict.h"

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

}  // namespace dmise
