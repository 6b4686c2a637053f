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

/// A motion across the sky that a streak shows beside its direction.
struct SeenMotion {
  AngleObservation observation;       // with the velocity of the sensor
  Vec<Gcrs> rate_rad_per_s;           // rate of the direction as the sensor sees it, or against it
  double rate_sigma_rad_per_s = 0.0;  // along each axis
};

/// Where a sensor will see an object, and how fast it moves there.
struct PredictedMotion {
  PredictedDirection direction;
  Vec<Gcrs> rate_rad_per_s;                              // for the sensor with its velocity
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  // east, north; their rates; of the orbit
};

PredictedMotion predict_motion(const OrbitEstimate& estimate, const Vec<Gcrs>& sensor_m,
                               const Vec<Gcrs>& sensor_m_per_s, SimTime time);

/// Observed minus predicted direction and rate, the rate with the sign that is nearer.
struct MotionInnovation {
  Eigen::Vector4d residual = Eigen::Vector4d::Zero();
  double d2 = 0.0;      // chi-square of 4 degrees of freedom
  double spread = 0.0;  // logarithm of the determinant of 2 pi S
};

MotionInnovation innovation_of(const PredictedMotion& predicted, const SeenMotion& observed);

}  // namespace dmise
