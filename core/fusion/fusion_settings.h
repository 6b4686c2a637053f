#pragma once
#include <array>

#include "core/frames/geodesy.h"

namespace dmise {

/// What a fusion takes as known. Defaults are those of the scenario's key `fusion`.
struct FusionSettings {
  // Standard deviations of catalogued objects about their element sets, radial, along the motion
  // and across the orbit: at the epoch [m], and by which they grow with the age [m/day].
  std::array<double, 3> catalogue_sigma_m{300, 1000, 300};
  std::array<double, 3> catalogue_sigma_m_per_day{100, 1000, 100};
  double gate_d2 = 18.4;               // for a pair, chi-square of 2 degrees of freedom; 18.4: 1e-4
  double detection_probability = 0.9;  // for an object well above the limit, (0, 1)
  double false_alarms_per_frame = 1.0;
  double lost_after_s = 900.0;   // without a detection, of a confirmed track
  double tentative_s = 120.0;    // without a detection, of a tentative track
  double start_window_s = 60.0;  // between the first and the last detection that start a track
  double simultaneous_s = 0.5;   // between detections of two sites that give a position
  double arc_window_s = 240.0;   // within an arc that one site alone sees
  int arc_exposures = 4;         // least of such an arc, >= 4; 0: one site begins nothing
  double acceleration_noise_m2_per_s3 = 1e-6;
  // Error of a frame's directions that no detection knows [arcsec]: jitter, bias, drift.
  double pointing_sigma_arcsec = 0.0;
  Ellipsoid ellipsoid{};       // the Earth, which casts the shadow
  int confirm_catalogued = 3;  // detections that confirm a track of a catalogued object
  int confirm_unknown = 6;     // and one of another, which begins with four
  int confirm_arc = 4;         // more than it began with, of one that one site began
  bool keep_orbits = false;    // from arc to arc by numerical forces (KeptOrbits)
};

}  // namespace dmise
