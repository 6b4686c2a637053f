#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/numeric/rare.h"
#include "core/base/sim_time.h"
#include "core/frames/earth_orientation.h"
#include "core/frames/vec.h"
#include "core/orbit/attitude_interpolation.h"
#include "core/orbit/elements/elements.h"
#include "core/photometry/diffuse_sphere.h"

// Data exchanged between actors and evaluators, the same in one process and across a network.
namespace dmise {

/// Constant properties of one object.
struct ObjectInfo {
  std::uint32_t catalogue_number = 0;  // up to 9 digits
  std::string name;
  std::string designator;        // international designator, may be empty
  DiffuseSphere sphere;          // its brightness, unless it has a shape
  double element_age_s = 0.0;    // start of the run minus the epoch of the elements
  Rare<SunTrackingPanel> panel;  // none without an attitude

  bool operator==(const ObjectInfo &) const = default;
};

/// All objects of a run; the position in this list is the object's index everywhere else.
struct ObjectRoster {
  std::vector<ObjectInfo> objects;
  std::vector<MeanElements> elements;  // for the first objects, those that SGP4 moves

  bool operator==(const ObjectRoster &) const = default;
};

/// In place of an object's albedo, where nobody tells one: that of the roster.
inline constexpr double roster_albedo = -1.0;

/// States of all objects at one tick in GCRS, as a structure of arrays. Slope is the derivative of
/// the position (symmetric difference of the propagator), for interpolation; velocity is the
/// model's. An object with `code` != 0 has no state: its numbers are 0. Attitudes, which few
/// objects have, are in separate arrays, in the order of `attitude_object`.
struct ObjectStates {
  Tick tick = 0;
  SimTime time;
  std::size_t count = 0;
  std::vector<double> position_m;               // 3 x count: all x, all y, all z
  std::vector<double> slope_m_per_s;            // 3 x count
  std::vector<double> velocity_m_per_s;         // 3 x count
  std::vector<std::uint8_t> code;               // count; 0 or the error code of the motion model
  std::vector<std::uint32_t> attitude_object;   // m indices of objects, ascending
  std::vector<double> gcrs_from_body;           // 4 x m: all w, x, y, z of unit quaternions
  std::vector<double> attitude_rate_rad_per_s;  // 3 x m: angular velocity, GCRS axes
  std::vector<double> albedo;                   // count, or `roster_albedo`; empty: all are that

  Vec<Gcrs> position(std::size_t i) const {
    return {position_m[i], position_m[count + i], position_m[2 * count + i]};
  }
  Vec<Gcrs> slope(std::size_t i) const {
    return {slope_m_per_s[i], slope_m_per_s[count + i], slope_m_per_s[2 * count + i]};
  }
  /// Albedo of object `i` at this tick; empty if it is that of the roster.
  std::optional<double> albedo_of(std::size_t i) const {
    return albedo.empty() || albedo[i] == roster_albedo ? std::nullopt : std::optional(albedo[i]);
  }
  /// Attitude of object `i`; empty if it has none.
  std::optional<AttitudeState> attitude(std::size_t i) const {
    const auto found = std::ranges::lower_bound(attitude_object, i);
    if (found == attitude_object.end() || *found != i || code[i] != 0) return std::nullopt;
    const std::size_t m = attitude_object.size();
    const auto k = static_cast<std::size_t>(found - attitude_object.begin());
    const double *q = gcrs_from_body.data() + k, *w = attitude_rate_rad_per_s.data() + k;
    return AttitudeState{{q[0], q[m], q[2 * m], q[3 * m]}, {w[0], w[m], w[2 * m]}};
  }

  bool operator==(const ObjectStates &) const = default;
};

/// Atmosphere above one ground sensor, at one tick; valid until the next one.
struct SiteState {
  Tick tick = 0;
  SimTime time;
  std::string sensor;
  double extinction_mag_per_airmass = 0.0;  // at 550 nm
  double pressure_hpa = 0.0, temperature_c = 0.0, humidity = 0.0;
  double cloud_transmission = 1.0;  // at the zenith now, [0, 1]
  // Turbulence towards the zenith at 500 nm; all 0 without a profile.
  double r0_m = 0.0;
  double isoplanatic_angle_rad = 0.0;
  double tau0_s = 0.0;
  double turbulence_m_per_s = 0.0;

  bool operator==(const SiteState &) const = default;
};

/// Environment common to all sensors, at one tick.
struct EnvironmentState {
  Tick tick = 0;
  SimTime time;
  EarthOrientation earth;
  Vec<Gcrs> sun_m;                    // geocentric, geometric, of date in GCRS
  Vec<Gcrs> moon_m;                   // geocentric
  Vec<Gcrs> earth_barycentric_m;      // the Earth's centre, ICRS axes
  Vec<Gcrs> earth_velocity_m_per_s;   // barycentric, for annual aberration
  double tt_jd1 = 0.0, tt_jd2 = 0.0;  // two-part TT Julian date of `time` [days]
  Vec<Gcrs> moon_velocity_m_per_s;    // geocentric: the derivative of `moon_m`
  /// `slope_half_step_s` before and after `time`, where sensors propagate objects.
  std::optional<std::array<EarthOrientation, 2>> earth_beside;

  bool operator==(const EnvironmentState &) const = default;
};

}  // namespace dmise
