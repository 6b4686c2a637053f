#pragma once
#include <array>
#include <optional>
#include <string_view>

#include "core/optics/exclusion.h"

namespace dmise {

class View;

/// Least angles of the optical axis from bodies over an exposure [rad], from the opening of the
/// first row to the end of the last; none from a body that the Earth hides throughout.
struct BodyAngles {
  std::optional<double> sun_rad, moon_rad;  // from their centres
  std::optional<double> earth_limb_rad;     // from its nearest point, in orbit; < 0: at the Earth
};

/// A body that may exclude, with its names and values.
struct ExcludingBody {
  std::string_view key;
  const char* name;
  std::optional<double> Exclusion::*limit_deg;
  std::optional<double> BodyAngles::*angle_rad;
  bool Excluded::*excluded;
};
inline constexpr std::array<ExcludingBody, 3> excluding_bodies{
    {{"sun", "the Sun", &Exclusion::sun_deg, &BodyAngles::sun_rad, &Excluded::sun},
     {"moon", "the Moon", &Exclusion::moon_deg, &BodyAngles::moon_rad, &Excluded::moon},
     {"earth_limb", "the Earth's limb", &Exclusion::earth_limb_deg, &BodyAngles::earth_limb_rad,
      &Excluded::earth_limb}}};

/// Returns the angles for which the camera has a limit: between the true axis, with errors of
/// pointing, and the apparent places of the bodies, with all effects of place that the scenario
/// asks for. Accurate to 1e-6 rad, also for a camera that turns many times in an exposure.
BodyAngles body_angles(const View& view);

/// Returns which angles are less than the camera's limits.
Excluded excluded_by(const Exclusion& exclusion, const BodyAngles& angles);

}  // namespace dmise
