#pragma once
#include <span>
#include <vector>

#include "core/base/units.h"
#include "core/tracking/maintenance/catalogue_object.h"
#include "core/tracking/predict.h"

namespace dmise {

/// What a sensor saw at one time about where an object was expected.
struct PassExposure {
  SimTime time;
  Vec<Gcrs> sensor_m, sensor_m_per_s;
  double half_angle_rad = pi;  // half of the field, about the place where the object is expected
  std::vector<SeenMotion> sources;
  std::vector<OrbitEstimate> others;  // at `time`: objects that may be in the field
};

struct PassAssociationSettings {
  bool rates = true;                // false: by directions alone
  double direction_gate_d2 = 18.4;  // chi-square of 2 degrees of freedom: 1e-4
  double motion_gate_d2 = 23.5;     // chi-square of 4
  double detection_probability = 0.83;
  double false_per_sr = 0.5;              // false alarms of an exposure
  double max_rate_rad_per_s = 1.5 * deg;  // rates of false alarms
  double min_odds = 100.0;                // a pair over all else that may have made the source
  // A manoeuvre since the last observation, along each axis, for passes without the object.
  double manoeuvre_m_per_s = 0.3;
};

/// The observations of a pass that are an object's.
struct PassArc {
  std::vector<AngleObservation> observations;
  std::size_t ambiguous = 0;       // sources that may as well be another's
  bool after_a_manoeuvre = false;  // found only where a manoeuvre may have led
};

/// Which sources of a pass are of an object that is known by `estimate`, at or before the first
/// exposure: of each exposure one assignment over it and all others, by direction and rate with
/// their covariances. Sources that others may have made as well are refused.
Outcome<PassArc> associate_pass(const ForceModel& forces, const OrbitEstimate& estimate,
                                std::span<const PassExposure> exposures,
                                const PassAssociationSettings& settings = {});

/// As above with the orbit of an object that is kept. If it is not where it should be, it is looked
/// for where a manoeuvre after its last observation may have led.
Outcome<PassArc> associate_pass(const MaintenanceForces& forces, const CatalogueObject& object,
                                std::span<const PassExposure> exposures,
                                const PassAssociationSettings& settings = {});

}  // namespace dmise
