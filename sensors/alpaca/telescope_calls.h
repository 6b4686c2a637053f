#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "sensors/alpaca/alpaca_devices.h"

// What members of a telescope are given.
namespace dmise {

inline constexpr double hour_deg = 15.0;

inline double ranged(const MemberCall& c, const char* name, double low, double high) {
  const double value = c.given.number(name);
  if (!(value >= low && value <= high))
    refuse_value(std::string(name) + " must be " + std::to_string(low) + " to " +
                 std::to_string(high));
  return value;
}

inline double ra_h(const MemberCall& c, const char* name = "RightAscension") {
  const double value = ranged(c, name, 0.0, 24.0);
  if (value == 24.0) refuse_value(std::string(name) + " must be below 24");
  return value;
}
inline double dec_deg(const MemberCall& c, const char* name = "Declination") {
  return ranged(c, name, -90.0, 90.0);
}
inline Equatorial place_of(double ra_h, double dec_deg) { return {ra_h * hour_deg, dec_deg}; }

inline double needed(const std::optional<double>& value) {
  if (!value) throw DeviceError(DeviceFault::value_not_set, "the target was never set");
  return *value;
}
inline Equatorial target_of(const MemberCall& c) {
  return place_of(needed(c.session.target_ra_h), needed(c.session.target_dec_deg));
}

inline Equatorial given_place(const MemberCall& c) { return place_of(ra_h(c), dec_deg(c)); }
/// What is given becomes the target.
inline void set_target(const MemberCall& c) {
  c.session.target_ra_h = ra_h(c);
  c.session.target_dec_deg = dec_deg(c);
}

inline Horizontal given_horizontal(const MemberCall& c) {
  const double azimuth_deg = ranged(c, "Azimuth", 0.0, 360.0);
  const double altitude_deg = ranged(c, "Altitude", -90.0, 90.0);
  return {std::fmod(azimuth_deg, 360.0) * deg, altitude_deg * deg};
}

inline int axis_of(const MemberCall& c) {
  const int axis = c.given.integer("Axis");
  if (axis < 0 || axis > 2) refuse_value("Axis must be 0 to 2");
  return axis;
}

std::vector<Member> telescope_motions();
std::vector<Member> telescope_commands();

}  // namespace dmise
