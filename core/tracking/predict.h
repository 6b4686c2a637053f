#pragma once
#include <Eigen/Core>

#include "core/tracking/angle_observation.h"
#include "core/tracking/orbit_state.h"

namespace dmise {

/// Where a sensor will see an object.
struct PredictedDirection {
  SimTime time;                                               // when the light is received
  Vec<Gcrs> direction;                                        // unit, without aberration
  Eigen::Matrix2d covariance_rad2 = Eigen::Matrix2d::Zero();  // east, north; of the orbit alone
  double range_m = 0.0;                                       // to where the light left
  double range_rate_m_per_s = 0.0;                            // for an observer at rest
  Vec<Gcrs> rate_rad_per_s;  // change of `direction`, perpendicular to it, for an observer at rest
};

/// To first order in the covariance. The estimate must be within a few seconds of `time`: it is
/// moved to the instant when the light left by two-body motion. `sensor_m` is the sensor at `time`.
PredictedDirection predict_direction(const OrbitEstimate& estimate, const Vec<Gcrs>& sensor_m,
                                     SimTime time);

/// Observed minus predicted.
struct Innovation {
  Eigen::Vector2d residual_rad = Eigen::Vector2d::Zero();     // east, north
  Eigen::Matrix2d covariance_rad2 = Eigen::Matrix2d::Zero();  // S: of prediction and observation
  double d2 = 0.0;              // residual' S^-1 residual, chi-square of 2 degrees of freedom
  double log_likelihood = 0.0;  // logarithm of the residual's density [ln(1/rad^2)]
};

Innovation innovation_of(const PredictedDirection& predicted, const AngleObservation& observed);

}  // namespace dmise
