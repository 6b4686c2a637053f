#pragma once
#include <cstdint>
#include <vector>

#include "core/forces/forces.h"
#include "core/tracking/angle_observation.h"
#include "core/tracking/orbit_state.h"

namespace dmise {

/// A pass of an object over sites that see it at the same times.
struct TrackingTrial {
  OrbitState truth;                            // at time 0
  std::vector<AngleObservation> observations;  // by time, then site
};

struct TrialSettings {
  int sites = 3;
  int exposures = 20;
  double cadence_s = 10.0;
  double sigma_rad = 4.84813681109536e-6;  // 1 arcsec
  double height_m = 1000e3;                // at the middle of the pass, above the middle site
  double baseline_m = 1000e3;              // between neighbouring sites
  double drag_m2_per_kg = 0.0;
  double height_scatter = 0.0;  // heights are multiplied by up to 1 +- this
};

/// A pass of which heading, heights, inclination to the sites and errors are drawn by `seed`.
TrackingTrial tracking_trial(const ForceModel& forces, const TrialSettings& settings,
                             std::uint64_t seed);

/// Where a sensor of the trial sees the object, without error.
AngleObservation observe(const ForceModel& forces, const OrbitState& truth, SimTime time,
                         const Vec<Gcrs>& sensor_m);

/// Position of a site that turns with the Earth about the z axis.
Vec<Gcrs> turned_site(double latitude_rad, double longitude_rad, SimTime time);

}  // namespace dmise
