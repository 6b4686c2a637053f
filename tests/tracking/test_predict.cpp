#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/orbit/two_body.h"
#include "core/tracking/predict.h"

namespace dmise {
namespace {

const Vec<Gcrs> station_m{6.37e6, 0, 0}, station_m_per_s{0, 464, 0};

OrbitEstimate orbit_above() {
  OrbitEstimate out{{SimTime{}, {7.0e6, 5e5, 4e5}, {-800, 5200, 5300}}};
  OrbitVector sigma;
  sigma << 300, 500, 200, 0.4, 0.3, 0.5, 0, 0;
  out.covariance = sigma.array().square().matrix().asDiagonal();
  return out;
}

// Reference: the direction a second later, for a sensor that has moved.
TEST(PredictedMotion, RateIsTheDerivativeOfTheDirection) {
  const PredictedMotion now = predict_motion(orbit_above(), station_m, station_m_per_s, SimTime{});
  constexpr double step_s = 0.1;
  const auto at = [&](double t) {
    return predict_direction(orbit_above(), station_m + station_m_per_s * t, sim_seconds(t))
        .direction;
  };
  const Vec<Gcrs> slope = (at(step_s) - at(-step_s)) / (2 * step_s);
  EXPECT_LT(norm(slope - now.rate_rad_per_s), 1e-4 * norm(slope));
}

// Reference: differences of predictions from states that are moved.
TEST(PredictedMotion, CovarianceIsThatOfMovedStates) {
  const PredictedMotion now = predict_motion(orbit_above(), station_m, station_m_per_s, SimTime{});
  const SkyTangents tangents = sky_tangents(now.direction.direction);
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (int row = 0; row < 6; ++row) {
    OrbitEstimate moved = orbit_above();
    const double sigma = std::sqrt(moved.covariance(row, row));
    OrbitVector state = vector_of(moved.state);
    state[row] += sigma;
    moved.state = state_of(state, SimTime{});
    const PredictedMotion there = predict_motion(moved, station_m, station_m_per_s, SimTime{});
    const Vec<Gcrs> turn = there.rate_rad_per_s - now.rate_rad_per_s;
    Eigen::Vector4d by;
    by << angles_between(now.direction.direction, there.direction.direction),
        dot(turn, tangents.east), dot(turn, tangents.north);
    sum += by * by.transpose();
  }
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(std::sqrt(now.covariance(i, i)), std::sqrt(sum(i, i)), 0.01 * std::sqrt(sum(i, i)))
        << i;
}

TEST(MotionInnovation, TakesAStreakOfEitherDirection) {
  const PredictedMotion now = predict_motion(orbit_above(), station_m, station_m_per_s, SimTime{});
  SeenMotion seen{{.time = {}, .sensor_m = station_m, .direction = now.direction.direction}};
  seen.observation.covariance_rad2 = {1e-8, 0, 1e-8};
  seen.rate_sigma_rad_per_s = 1e-5;
  seen.rate_rad_per_s = -1.0 * now.rate_rad_per_s;
  EXPECT_LT(innovation_of(now, seen).d2, 1e-12);
  seen.rate_rad_per_s = 1.5 * now.rate_rad_per_s;
  EXPECT_GT(innovation_of(now, seen).d2, 100);
}

}  // namespace
}  // namespace dmise
