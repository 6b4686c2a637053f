#pragma once

#include <array>

namespace dmise {

/// great_circle: turns along the great circle, without limits of axes. altazimuth: azimuth and
/// elevation turn at once, each at its rate.
enum class MountKind { great_circle, altazimuth };

/// What a sensor that is cued can do, and what its detections are expected to be. Defaults are
/// those of the scenario's key `pointing.cued`.
struct CueSettings {
  double slew_deg_per_s = 5.0;   // fastest turn of the mount, > 0; of following a target, too
  double slew_deg_per_s2 = 0.0;  // its acceleration; 0: it has its speed at once
  double settle_s = 2.0;         // after a slew, >= 0
  MountKind mount = MountKind::great_circle;
  // The azimuth axis of an altazimuth mount, the two above being those of elevation; 0: as those.
  double azimuth_deg_per_s = 0.0, azimuth_deg_per_s2 = 0.0;
  // From north through east, with whole turns: more than 360 deg wide, or some sky is out of reach.
  std::array<double, 2> azimuth_range_deg{-270.0, 270.0};
  double min_elevation_deg = 20.0, greatest_elevation_deg = 90.0;
  double sun_exclusion_deg = 30.0, moon_exclusion_deg = 5.0;  // from their middles
  int exposures = 3;                                          // most of one task, >= 1
  double sigma_arcsec = 1.0;                                  // error of a place on each axis, > 0
  double limiting_magnitude = 14.0;
  double min_gain_nats = 0.1;  // a task that is expected to tell less is not given
};

}  // namespace dmise
