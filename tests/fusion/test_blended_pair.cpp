#include "core/fusion/blended_pair.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/base/units.h"

namespace dmise {
namespace {

using Vector4 = Eigen::Vector4d;
using Matrix4 = Eigen::Matrix4d;
using Matrix24 = Eigen::Matrix<double, 2, 4>;

constexpr double unit_rad = 1 * arcsec;

Eigen::Matrix2d covariance(double east, double north, double correlation) {
  Eigen::Matrix2d out;
  out << east * east, correlation * east * north, correlation * east * north, north * north;
  return out * unit_rad * unit_rad;
}

PredictedDirection at(double east, double north, const Eigen::Matrix2d& covariance_rad2) {
  const Vec<Gcrs> middle = from_spherical<Gcrs>(1.0, 0.3);
  const SkyTangents t = sky_tangents(middle);
  return {.direction = unit(middle + (t.east * east + t.north * north) * unit_rad),
          .covariance_rad2 = covariance_rad2,
          .range_m = 3.7e7};
}

/// The update of a direction by its part of a blend, alone: place [rad] and covariance.
std::pair<Eigen::Vector2d, Eigen::Matrix2d> updated(const PredictedDirection& prior,
                                                    const AngleObservation& part) {
  const Innovation off = innovation_of(prior, part);
  const Eigen::Matrix2d gain = prior.covariance_rad2 * off.covariance_rad2.inverse();
  return {gain * off.residual_rad, prior.covariance_rad2 - gain * prior.covariance_rad2};
}

// Reference: Kalman's update of both objects' four coordinates by the centre of their light.
TEST(BlendedPair, EachPartUpdatesAsTheJointEstimateDoes) {
  const Eigen::Matrix2d of_a = covariance(0.5, 0.2, 0.4), of_b = covariance(0.3, 0.6, -0.2);
  const PredictedDirection a = at(-0.4, 0.1, of_a), b = at(0.5, -0.2, of_b);
  const PredictedDirection source = at(0.15, 0.2, {});
  const AngleObservation seen{
      .direction = source.direction,
      .covariance_rad2 = {0.04 * unit_rad * unit_rad, 0.0, 0.09 * unit_rad * unit_rad}};
  const double share = 0.6;
  const BlendedPair blend = blended_pair(seen, a, b, share);

  Matrix4 prior = Matrix4::Zero();
  prior.topLeftCorner<2, 2>() = of_a;
  prior.bottomRightCorner<2, 2>() = of_b;
  Matrix24 centre;
  centre << share, 0, 1 - share, 0, 0, share, 0, 1 - share;
  const Eigen::Vector2d residual = share * angles_between(a.direction, seen.direction) +
                                   (1 - share) * angles_between(b.direction, seen.direction);
  const Eigen::Vector2d apart = 0.1 * angles_between(a.direction, b.direction);
  const Eigen::Matrix2d all =
      centre * prior * centre.transpose() + covariance_of(seen) + apart * apart.transpose();
  const Eigen::Matrix<double, 4, 2> gain = prior * centre.transpose() * all.inverse();
  const Vector4 moved = gain * residual;
  const Matrix4 posterior = prior - gain * centre * prior;

  EXPECT_NEAR(blend.d2, residual.dot(all.inverse() * residual), 1e-6);
  const auto [place_a, after_a] = updated(a, blend.parts[0]);
  const auto [place_b, after_b] = updated(b, blend.parts[1]);
  EXPECT_LT((place_a - moved.head<2>()).norm(), 1e-5 * unit_rad);
  EXPECT_LT((place_b - moved.tail<2>()).norm(), 1e-5 * unit_rad);
  const double tolerance = 1e-5 * unit_rad * unit_rad;
  EXPECT_LT((after_a - posterior.topLeftCorner<2, 2>()).norm(), tolerance);
  EXPECT_LT((after_b - posterior.bottomRightCorner<2, 2>()).norm(), tolerance);
}

// Between two objects of equal light and errors both are where they were predicted to be.
TEST(BlendedPair, ASourceInTheMiddleMovesNeither) {
  const Eigen::Matrix2d both = covariance(0.3, 0.3, 0.0);
  const PredictedDirection a = at(-0.5, 0.0, both), b = at(0.5, 0.0, both);
  const AngleObservation seen{.direction = unit(a.direction + b.direction),
                              .covariance_rad2 = {unit_rad * unit_rad, 0, unit_rad * unit_rad}};
  const BlendedPair blend = blended_pair(seen, a, b, 0.5);
  EXPECT_NEAR(blend.d2, 0.0, 1e-9);
  EXPECT_LT(angle_rad(blend.parts[0].direction, a.direction), 1e-6 * unit_rad);
  EXPECT_LT(angle_rad(blend.parts[1].direction, b.direction), 1e-6 * unit_rad);
}

}  // namespace
}  // namespace dmise
