#pragma once
#include <string_view>

#include "core/base/error.h"
#include "core/orbit/elements/elements.h"

// Shared by the readers of element sets: a record becomes `MeanElements` or is refused.
namespace dmise {

/// Thrown for one bad record of a file; the message is its `reason, got "value"`.
class RecordError : public ConfigError {
 public:
  using ConfigError::ConfigError;
};

/// Parses `text` (blanks around it allowed) as a number in [low, high]. Throws `RecordError` naming
/// `what`.
double real_in(std::string_view text, const char* what, double low, double high);

/// Parses `text` as an integer >= 0, 0 if blank. Throws `RecordError` naming `what`.
int count_or_zero(std::string_view text, const char* what);

/// Throws `RecordError` unless the type is 0, 2 or 3, which are all SGP4/SDP4. Type 4 (SGP4-XP) has
/// the same format but a different meaning.
void check_ephemeris_type(int type);

/// An orbit in the units in which TLE and OMM publish it.
struct PublishedOrbit {
  double mean_motion_rev_per_day = 0.0;
  double eccentricity = 0.0;
  double inclination_deg = 0.0;
  double raan_deg = 0.0;
  double argument_of_perigee_deg = 0.0;
  double mean_anomaly_deg = 0.0;
  double mean_motion_dot_rev_per_day2 = 0.0;   // half the derivative
  double mean_motion_ddot_rev_per_day3 = 0.0;  // a sixth of it
};

/// Sets the orbit in SI, with the exact arithmetic of the reference implementation (AIAA
/// 2006-6753).
void set_orbit(const PublishedOrbit& orbit, MeanElements& elements);

}  // namespace dmise
