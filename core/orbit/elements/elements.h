#pragma once
#include <cstdint>
#include <string>

namespace dmise {

/// One mean element set as SGP4 takes it (a TLE or an OMM with the theory SGP4). Angles in TEME of
/// epoch. The epoch is two numbers because one double of days since -4712 rounds to 40 us: 0.3 m.
struct MeanElements {
  std::uint32_t catalogue_number = 0;    // up to 9 digits
  std::string name;                      // empty where the source gives none
  std::string designator;                // international designator "98067A"; empty where unknown
  double epoch_jd1 = 0.0;                // UTC Julian date of the epoch's midnight [d], ends in .5
  double epoch_jd2 = 0.0;                // time of day [d, 0..1)
  double mean_motion_rad_per_min = 0.0;  // Kozai's mean motion, as published
  double eccentricity = 0.0;             // [0, 1)
  double inclination_rad = 0.0;          // [0, pi]
  double raan_rad = 0.0;                 // right ascension of the ascending node
  double argument_of_perigee_rad = 0.0;
  double mean_anomaly_rad = 0.0;
  double bstar_per_earth_radius = 0.0;         // drag term B* [1 / Earth radius]
  double mean_motion_dot_rad_per_min2 = 0.0;   // half the derivative, as in a TLE; not used
  double mean_motion_ddot_rad_per_min3 = 0.0;  // a sixth of the second one, likewise
  int ephemeris_type = 0;                      // 0: SGP4; 4: SGP4-XP, which is not SGP4
  int element_number = 0;
  int revolution = 0;  // revolution number at epoch
  char classification = 'U';

  bool operator==(const MeanElements&) const = default;
};

}  // namespace dmise
