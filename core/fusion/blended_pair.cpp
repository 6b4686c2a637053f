#include "core/fusion/blended_pair.h"

#include <Eigen/LU>

namespace dmise {
namespace {

constexpr double share_error = 0.1;  // relative error of either's light: bodies turn

AngleObservation part_of(const AngleObservation& seen, const PredictedDirection& one,
                         const Eigen::Vector2d& residual_rad, const Eigen::Matrix2d& covariance) {
  AngleObservation part = seen;
  const SkyTangents tangents = sky_tangents(one.direction);
  part.direction =
      unit(one.direction + tangents.east * residual_rad[0] + tangents.north * residual_rad[1]);
  part.covariance_rad2 = {covariance(0, 0), covariance(0, 1), covariance(1, 1)};
  part.range_m = part.range_rate_m_per_s = {};
  return part;
}

}  // namespace

BlendedPair blended_pair(const AngleObservation& seen, const PredictedDirection& first,
                         const PredictedDirection& second, double share) {
  const double other = 1 - share;
  const Eigen::Vector2d to_first = angles_between(first.direction, seen.direction),
                        to_second = angles_between(second.direction, seen.direction);
  const Eigen::Vector2d residual = share * to_first + other * to_second;
  const Eigen::Vector2d apart = share_error * (to_first - to_second);
  const Eigen::Matrix2d noise = covariance_of(seen) + apart * apart.transpose();
  const Eigen::Matrix2d of_first = share * share * first.covariance_rad2,
                        of_second = other * other * second.covariance_rad2;
  BlendedPair out;
  const Eigen::Matrix2d all = noise + of_first + of_second;
  out.d2 = residual.dot(all.inverse() * residual);
  out.parts = {part_of(seen, first, residual / share, (noise + of_second) / (share * share)),
               part_of(seen, second, residual / other, (noise + of_first) / (other * other))};
  return out;
}

}  // namespace dmise
