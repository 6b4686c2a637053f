#pragma once
#include <memory>

#include "core/forces/forces.h"
#include "core/tracking/orbit_state.h"
#include "core/tracking/outcome.h"
#include "core/tracking/predict.h"
#include "core/tracking/propagate.h"

namespace dmise {

struct FilterSettings {
  // Spectral density of white noise in the acceleration, along each axis [m^2/s^3]; >= 0.
  double acceleration_noise_m2_per_s3 = 1e-9;
  double longest_s = 3 * 86400.0;  // farthest that an estimate is moved to an observation, > 0
  int kept = 64;                   // observations that a late one may still precede, >= 1
};

/// Square-root unscented Kalman filter of one object's orbit (van der Merwe & Wan 2001) with light
/// time inside the observation. Observations may come late: those after them are kept and processed
/// again, so that the result is that of their order in time, whatever the order of arrival, as long
/// as not more than `kept` lie between.
class OrbitFilter {
 public:
  /// Whether a filter can start from it: it is sane, and its covariance is positive definite in the
  /// rows that are estimated.
  static bool can_start(const OrbitEstimate& estimate);

  /// Throws `Error` for an estimate that is not sane, a covariance that is not positive definite in
  /// the rows that are estimated, or settings out of range. `forces` must live as long.
  OrbitFilter(const ForceModel& forces, const OrbitEstimate& start,
              const FilterSettings& settings = {});
  ~OrbitFilter();
  OrbitFilter(OrbitFilter&&) noexcept;

  /// The time of the last observation that was taken.
  SimTime time() const;
  OrbitEstimate estimate() const;

  /// The estimate at another time, at or after the oldest that is kept; the filter stays as it is.
  Outcome<OrbitEstimate> estimate_at(SimTime time) const;

  /// Where a sensor at `sensor_m` will see the object at `time`, by sigma points.
  Outcome<PredictedDirection> predict(SimTime time, const Vec<Gcrs>& sensor_m) const;

  /// What `update` would find; the filter stays as it is.
  Outcome<Innovation> innovation(const AngleObservation& observation) const;

  /// Takes an observation, of any time that is not before the oldest kept. Returns its innovation.
  /// Refuses, and stays as it was, if the observation has a fault, is older than what is kept, more
  /// than `longest_s` after what is known, or the path of a sigma point enters the Earth.
  Outcome<Innovation> update(const AngleObservation& observation);

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace dmise
