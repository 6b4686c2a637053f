#pragma once

namespace dmise {

/// What a sensor that is cued can do, and what its detections are expected to be. Defaults are
/// those of the scenario's key `pointing.cued`.
struct CueSettings {
  double slew_deg_per_s = 5.0;   // fastest turn of the mount, > 0; of following a target, too
  double slew_deg_per_s2 = 0.0;  // its acceleration; 0: it has its speed at once
  double settle_s = 2.0;         // after a slew, >= 0
  double least_elevation_deg = 20.0;
  double sun_exclusion_deg = 30.0, moon_exclusion_deg = 5.0;  // from their middles
  int exposures = 3;                                          // most of one task, >= 1
  double sigma_arcsec = 1.0;                                  // of a detection along each axis, > 0
  double limiting_magnitude = 14.0;
  double least_gain_nats = 0.1;  // a task that is expected to tell less is not given
};

}  // namespace dmise
