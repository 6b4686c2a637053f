#pragma once
#include <optional>

#include "core/base/pixel.h"

namespace dmise {

struct Optics;

/// Position in the field: distance and angle (from +x to +y) from the principal point, 1 at the
/// frame's farthest corner.
struct FieldPlace {
  double radius = 0.0;
  double angle_rad = 0.0;

  bool operator==(const FieldPlace&) const = default;
};

/// How a table of a camera states the distance from its axis.
enum class FieldRadius {
  angle_deg,    // from the boresight
  distance_px,  // from the principal point
};

/// "radius_deg", "radius_px"
inline const char* name(FieldRadius unit) {
  return unit == FieldRadius::angle_deg ? "radius_deg" : "radius_px";
}

/// "deg", "px"
inline const char* unit_text(FieldRadius unit) {
  return unit == FieldRadius::angle_deg ? "deg" : "px";
}

/// Distance of a pixel from the axis, in the unit of a table. Empty where no direction is imaged
/// and the table has angles.
std::optional<double> field_radius(const Optics& optics, PixelPosition pixel, FieldRadius unit);

/// Radius of an image height; along +x for a lens that is not symmetric.
std::optional<double> field_radius_at(const Optics& optics, double height_px, FieldRadius unit);

/// Image height of such a distance [px]; infinite where the lens images nothing.
double height_px(const Optics& optics, double radius, FieldRadius unit);

/// Place in the field of a pixel.
FieldPlace field_place(const Optics& optics, PixelPosition pixel);

/// Distance of the frame's corners from the principal point [px].
double corner_px(const Optics& optics);

}  // namespace dmise
