#include "core/optics/projection.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/optics/image_height.h"

namespace dmise {
PixelPosition principal_point(const Optics& o) {
  return {0.5 * (o.columns - 1), 0.5 * (o.rows - 1)};
}

std::optional<PixelPosition> project(const Optics& o, const Vec<CameraFrame>& direction) {
  const Vec<CameraFrame> v = unit(direction);
  const auto image = image_of_direction(o.projection, v.x, v.y, v.z);
  if (!image) return std::nullopt;
  const double f = o.focal_length_px();
  return principal_point(o) + PixelPosition{f * (*image)[0], f * (*image)[1]};
}

std::optional<Vec<CameraFrame>> unproject(const Optics& o, PixelPosition pixel) {
  const PixelPosition d = (pixel - principal_point(o)) * (1.0 / o.focal_length_px());
  const auto v = direction_of_image(o.projection, d.x_px, d.y_px);
  if (!v) return std::nullopt;
  return Vec<CameraFrame>{(*v)[0], (*v)[1], (*v)[2]};
}

double pixel_solid_angle_sr(const Optics& o, PixelPosition pixel) {
  const double f = o.focal_length_px();
  const PixelPosition d = pixel - principal_point(o);
  const auto theta = axis_angle_rad(o.projection, std::hypot(d.x_px, d.y_px) / f);
  if (!theta) return 0.0;
  const double centre_sr = 1.0 / (f * f);
  switch (o.projection) {
    case Projection::gnomonic:
      return centre_sr * std::pow(std::cos(*theta), 3);
    case Projection::equidistant:
      return centre_sr * (*theta > 0.0 ? std::sin(*theta) / *theta : 1.0);
    case Projection::equisolid:
      return centre_sr;
    case Projection::stereographic:
      return centre_sr * std::pow(std::cos(*theta / 2), 4);
  }
  return 0.0;
}

double half_diagonal_rad(const Optics& o) {
  const double r = 0.5 * std::hypot(o.columns, o.rows) / o.focal_length_px();
  return axis_angle_rad(o.projection, r).value_or(pi);
}

}  // namespace dmise
