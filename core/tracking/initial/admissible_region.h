#pragma once
#include <span>
#include <vector>

#include "core/tracking/angle_observation.h"
#include "core/tracking/orbit_state.h"
#include "core/tracking/outcome.h"

namespace dmise {

/// Direction and its rate: what one short arc tells (Milani et al. 2004).
struct Tracklet {
  SimTime time;  // when the light was received
  Vec<Gcrs> sensor_m, sensor_m_per_s;
  Vec<Gcrs> direction;       // unit
  Vec<Gcrs> rate_rad_per_s;  // change of `direction`, perpendicular to it
};

/// A straight line in the sky, or an arc if there are more than two, through observations of one
/// sensor, at their mean time. Refuses fewer than two, equal times and several sensors.
Outcome<Tracklet> tracklet_of(std::span<const AngleObservation> observations);

struct AdmissibleSettings {
  double min_range_m = 1e5, largest_range_m = 1e8;
  OrbitLimits limits{.largest_apogee_m = 5e7};
  int ranges = 40, range_rates = 21;  // samples, >= 2
};

/// Range rates between which the energy is negative at a range; empty if there are none.
struct RangeRates {
  double min_m_per_s = 0.0, largest_m_per_s = 0.0;
  bool empty() const { return !(min_m_per_s < largest_m_per_s); }
};
RangeRates bound_range_rates(const Tracklet& tracklet, double range_m);

/// States when the light left, of ranges uniform in their logarithm and range rates uniform between
/// the bounds of energy. Those beyond the limits are left out. Refuses a region without a state.
Outcome<std::vector<OrbitState>> admissible_region(const Tracklet& tracklet,
                                                   const AdmissibleSettings& settings = {});

}  // namespace dmise
