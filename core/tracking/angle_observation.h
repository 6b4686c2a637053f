#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "core/base/sim_time.h"
#include "core/frames/vec.h"
#include "core/products/detection.h"
#include "core/products/measured_number.h"
#include "core/tracking/outcome.h"

namespace dmise {

/// A direction in which a sensor saw an object. The light that arrived at `time` left the object
/// range / c earlier: with r(t) the object's path, `direction` is that of r(time - range / c) -
/// sensor_m. Aberration is not in it.
/// Some sensors measure the length of that line as well, or its derivative by `time`.
struct AngleObservation {
  SimTime time;                             // when the light was received
  Vec<Gcrs> sensor_m;                       // where the line of sight begins, at `time`
  Vec<Gcrs> direction;                      // unit
  std::array<double, 3> covariance_rad2{};  // var east, cov, var north on the sky: ra cos dec, dec
  std::string sensor;                       // name of the sensor
  std::string detection_id;                 // "<sensor>/<frame>/<index>"
  std::optional<MeasuredNumber> range_m = {}, range_rate_m_per_s = {};
  Vec<Gcrs> sensor_m_per_s = {};  // with range_rate_m_per_s

  bool operator==(const AngleObservation&) const = default;
};

/// Unit vectors east and north on the sky at a direction; at a pole of GCRS east is +y.
struct SkyTangents {
  Vec<Gcrs> east, north;
};
SkyTangents sky_tangents(const Vec<Gcrs>& direction);

Eigen::Matrix2d covariance_of(const AngleObservation& observation);

/// Larger standard deviation of the direction, along east or along north [rad].
double sigma_rad(const AngleObservation& observation);
/// The largest of several observations; 0 of none.
double largest_sigma_rad(std::span<const AngleObservation> observations);

/// Angles from `from` to `to` along east and north at `from` [rad]: the length is the angle
/// between both, also if it is large.
Eigen::Vector2d angles_between(const Vec<Gcrs>& from, const Vec<Gcrs>& to);

/// The line of sight of a detection. On the ground it begins `refraction_offset_m` beside the
/// sensor, where the line outside the air begins, and neither the mean refraction parallax nor its
/// variance are in it (docs/wire.md, Directions of detections). For a streak it is that of mid
/// exposure. Refuses a detection whose numbers are not finite or whose covariance is not
/// positive definite.
Outcome<AngleObservation> angle_observation(const Detection& detection);

/// Empty if the time is within 73 years, all numbers are finite, the direction is a unit vector to
/// 1e-6, the sensor is within 1e12 m and the covariance is positive definite; else the reason.
std::string_view fault_of(const AngleObservation& observation);

}  // namespace dmise
