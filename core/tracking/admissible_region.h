#pragma once
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/tracking/angle_observation.h"
#include "core/tracking/orbit_limits.h"
#include "core/tracking/orbit_state.h"
#include "core/tracking/outcome.h"

namespace dmise {

/// Direction and its rate: what one short arc tells (Milani et al. 2004).
struct Tracklet {
  SimTime time;  // of reception
  Vec<Gcrs> sensor_m, sensor_m_per_s;
  Vec<Gcrs> direction;       // unit
  Vec<Gcrs> rate_rad_per_s;  // of `direction`, perpendicular to it
  // east, north [rad], east, north rate [rad/s].
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
};

/// A straight line in the sky, or an arc if there are more than two, through observations of one
/// sensor, at their mean time. Refuses fewer than two, equal times and several sensors.
Outcome<Tracklet> tracklet_of(std::span<const AngleObservation> observations);

/// A streak's, at the middle of its exposure, if it went from end 1 to end 2, or (`backwards`) from
/// end 2 to end 1: one frame does not tell. Its rate is the mean along the streak, its error that
/// of both ends. Refuses a point, ends of one time, and what `angle_observation` refuses.
Outcome<Tracklet> tracklet_of(const Detection& streak, bool backwards);

struct AdmissibleSettings {
  double least_range_m = 1e5, largest_range_m = 1e8;
  OrbitLimits limits{.largest_apogee_m = 5e7};
  int ranges = 40, range_rates = 21;  // samples, >= 2
};

/// A range and range rate that make a bound orbit with a perigee above the air.
struct AdmissiblePoint {
  double range_m = 0.0, range_rate_m_per_s = 0.0;
  OrbitState state;  // when the light left
};

/// Range rates between which the energy is negative at a range; empty if there are none.
struct RangeRates {
  double least_m_per_s = 0.0, largest_m_per_s = 0.0;
  bool empty() const { return !(least_m_per_s < largest_m_per_s); }
};
RangeRates bound_range_rates(const Tracklet& tracklet, double range_m);

/// Points of the region, ranges uniform in their logarithm, range rates uniform between the bounds
/// of energy, those that violate perigee or apogee left out. Refuses a region without a point.
Outcome<std::vector<AdmissiblePoint>> admissible_region(const Tracklet& tracklet,
                                                        const AdmissibleSettings& settings = {});

}  // namespace dmise
