#pragma once
#include <optional>

#include "core/optics/exclusion.h"

namespace dmise {

class View;

/// Least angles of the optical axis from bodies over an exposure [rad], from the opening of the
/// first row to the end of the last; none from a body that the Earth hides throughout.
struct BodyAngles {
  std::optional<double> sun_rad, moon_rad;  // from their centres
  std::optional<double> earth_limb_rad;     // from its nearest point, in orbit; < 0: at the Earth
};

/// Those that the camera has a limit for. Of the axis as it is, with what the sensor does not know
/// of its pointing, and of the places where the bodies are seen, with all effects of place that the
/// scenario asks for. To 1e-6 rad, also of a camera that turns
/// many times in an exposure.
BodyAngles body_angles(const View& view);

/// Which of them are less than the camera's limits.
Excluded excluded_by(const Exclusion& exclusion, const BodyAngles& angles);

}  // namespace dmise
