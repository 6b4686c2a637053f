#pragma once
#include <array>
#include <cmath>
#include <optional>

#include "core/base/units.h"
#include "core/optics/camera.h"

// The four projections in focal lengths, about an axis along +z: what a lens and a FITS world
// coordinate system share.
namespace dmise {

/// Angle from the axis [rad] of an image height in focal lengths; nothing beyond the projection.
inline std::optional<double> axis_angle_rad(Projection projection, double height) {
  switch (projection) {
    case Projection::gnomonic:
      return std::atan(height);
    case Projection::equidistant:
      return height < pi ? std::optional(height) : std::nullopt;
    case Projection::equisolid:
      return height < 2.0 ? std::optional(2 * std::asin(height / 2)) : std::nullopt;
    case Projection::stereographic:
      return 2 * std::atan(height / 2);
  }
  return std::nullopt;
}

/// Unit vector of an image place in focal lengths; nothing where no direction is imaged.
inline std::optional<std::array<double, 3>> direction_of_image(Projection projection, double x,
                                                               double y) {
  if (projection == Projection::gnomonic) {
    const double length = std::sqrt(x * x + y * y + 1.0);
    return std::array{x / length, y / length, 1.0 / length};
  }
  const double height = std::hypot(x, y);
  const auto angle = axis_angle_rad(projection, height);
  if (!angle) return std::nullopt;
  const double s = height > 0.0 ? std::sin(*angle) / height : 1.0;
  return std::array{s * x, s * y, std::cos(*angle)};
}

/// Image place in focal lengths of a unit vector; nothing where the projection has no image: 90 deg
/// and more from the axis for the gnomonic, exactly behind for the others.
inline std::optional<std::array<double, 2>> image_of_direction(Projection projection, double x,
                                                               double y, double z) {
  double scale = 0.0;  // image height / sin(angle)
  switch (projection) {
    case Projection::gnomonic:
      if (!(z > 1e-9)) return std::nullopt;
      scale = 1.0 / z;
      break;
    case Projection::equidistant: {
      const double sine = std::hypot(x, y);
      scale = sine > 0.0 ? std::atan2(sine, z) / sine : 1.0;
      break;
    }
    case Projection::equisolid:
      scale = std::sqrt(2.0 / (1.0 + z));
      break;
    case Projection::stereographic:
      scale = 2.0 / (1.0 + z);
      break;
  }
  if (!(z > -1.0 + 1e-15) || !std::isfinite(scale)) return std::nullopt;
  return std::array{scale * x, scale * y};
}

}  // namespace dmise
