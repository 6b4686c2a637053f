#include "core/optics/field_radius.h"

#include <cmath>
#include <limits>

#include "core/base/units.h"
#include "core/optics/projection.h"

namespace dmise {

std::optional<double> field_radius(const Optics& optics, PixelPosition pixel, FieldRadius unit) {
  if (unit == FieldRadius::angle_deg) {
    const auto direction = unproject(optics, pixel);
    if (!direction) return std::nullopt;
    return std::atan2(std::hypot(direction->x, direction->y), direction->z) / deg;
  }
  const PixelPosition d = pixel - principal_point(optics);
  return std::hypot(d.x_px, d.y_px);
}

std::optional<double> field_radius_at(const Optics& optics, double height_px, FieldRadius unit) {
  return field_radius(optics, principal_point(optics) + PixelPosition{height_px, 0.0}, unit);
}

double height_px(const Optics& optics, double radius, FieldRadius unit) {
  if (unit == FieldRadius::distance_px) return radius;
  if (radius * deg > optics.projection.row().widest_field_rad / 2)
    return std::numeric_limits<double>::infinity();
  return optics.focal_length_px() * optics.projection.height(radius * deg);
}

FieldPlace field_place(const Optics& optics, PixelPosition pixel) {
  const PixelPosition d = pixel - principal_point(optics);
  return {std::hypot(d.x_px, d.y_px) / corner_px(optics), std::atan2(d.y_px, d.x_px)};
}

double corner_px(const Optics& optics) { return 0.5 * std::hypot(optics.columns, optics.rows); }

}  // namespace dmise
