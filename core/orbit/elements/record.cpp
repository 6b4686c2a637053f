#include "core/orbit/elements/record.h"

#include <string>

#include "core/base/files/text_fields.h"
#include "core/base/units.h"

namespace dmise {

double real_in(std::string_view text, const char* what, double low, double high) {
  const auto value = parse_real(trimmed(text));
  if (!value) throw RecordError(std::string(what) + " is not a number" + got(text));
  if (*value < low || *value > high)
    throw RecordError(std::string(what) + " out of range" + got(text));
  return *value;
}

int count_or_zero(std::string_view text, const char* what) {
  if (trimmed(text).empty()) return 0;
  const auto value = parse_integer(trimmed(text));
  if (!value || *value < 0) throw RecordError(std::string(what) + " is not a number" + got(text));
  return *value;
}

void check_ephemeris_type(int type) {
  if (type != 0 && type != 2 && type != 3)
    throw RecordError("ephemeris type is not SGP4's" + got(std::to_string(type)));
}

void set_orbit(const PublishedOrbit& orbit, MeanElements& e) {
  const double rev_per_day = 1440.0 / (2.0 * pi);  // in one rad/min: divides, as the reference does
  e.mean_motion_rad_per_min = orbit.mean_motion_rev_per_day / rev_per_day;
  e.eccentricity = orbit.eccentricity;
  e.inclination_rad = orbit.inclination_deg * deg;
  e.raan_rad = orbit.raan_deg * deg;
  e.argument_of_perigee_rad = orbit.argument_of_perigee_deg * deg;
  e.mean_anomaly_rad = orbit.mean_anomaly_deg * deg;
  e.mean_motion_dot_rad_per_min2 = orbit.mean_motion_dot_rev_per_day2 / (rev_per_day * 1440.0);
  e.mean_motion_ddot_rad_per_min3 =
      orbit.mean_motion_ddot_rev_per_day3 / (rev_per_day * 1440.0 * 1440.0);
}

}  // namespace dmise
