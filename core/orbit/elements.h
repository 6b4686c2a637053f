#pragma once
#include <cstdint>
#include <string>

namespace dmise {

/// One mean element set for SGP4 (TEME of epoch, WGS72), as a TLE or an OMM carries it.
/// Rates are as printed there: half the first and a sixth of the second derivative of mean motion;
/// SGP4 itself uses neither.
struct MeanElements {
  std::uint32_t catalogue_number = 0;  // up to 9 digits
  std::string name;
  std::string designator;                // international designator as given, may be empty
  double epoch_jd1 = 0.0;                // UTC two-part Julian date [days]; ends in .5
  double epoch_jd2 = 0.0;                // [0, 1)
  double mean_motion_rad_per_min = 0.0;  // Kozai mean motion
  double eccentricity = 0.0;             // [0, 1)
  double inclination_rad = 0.0;
  double raan_rad = 0.0;
  double argument_of_perigee_rad = 0.0;
  double mean_anomaly_rad = 0.0;
  double bstar_per_earth_radius = 0.0;
  double mean_motion_dot_rad_per_min2 = 0.0;
  double mean_motion_ddot_rad_per_min3 = 0.0;
  int ephemeris_type = 0;
  int element_number = 0;
  int revolution = 0;
  char classification = 'U';

  bool operator==(const MeanElements&) const = default;
};

}  // namespace dmise
