#include "core/optics/projection.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

// Angle from the boresight of image height `r` focal lengths; nothing beyond the projection.
std::optional<double> theta_of(Projection projection, double r) {
  switch (projection) {
    case Projection::gnomonic:
      return std::atan(r);
    case Projection::equidistant:
      return r < pi ? std::optional(r) : std::nullopt;
    case Projection::equisolid:
      return r < 2.0 ? std::optional(2 * std::asin(r / 2)) : std::nullopt;
    case Projection::stereographic:
      return 2 * std::atan(r / 2);
  }
  return std::nullopt;
}

}  // namespace

PixelPosition principal_point(const Optics& o) {
  return {0.5 * (o.columns - 1), 0.5 * (o.rows - 1)};
}

std::optional<PixelPosition> project(const Optics& o, const Vec<CameraFrame>& direction) {
  const double length = norm(direction);
  const Vec<CameraFrame> v = direction / length;
  const double sine = std::hypot(v.x, v.y);
  double scale = 0.0;  // image height / sin theta, in focal lengths
  switch (o.projection) {
    case Projection::gnomonic:
      if (!(v.z > 1e-9)) return std::nullopt;
      scale = 1.0 / v.z;
      break;
    case Projection::equidistant:
      scale = sine > 0.0 ? std::atan2(sine, v.z) / sine : 1.0;
      break;
    case Projection::equisolid:
      scale = std::sqrt(2.0 / (1.0 + v.z));
      break;
    case Projection::stereographic:
      scale = 2.0 / (1.0 + v.z);
      break;
  }
  if (!(v.z > -1.0 + 1e-15) || !std::isfinite(scale)) return std::nullopt;
  const double f = o.focal_length_px();
  return principal_point(o) + PixelPosition{f * scale * v.x, f * scale * v.y};
}

std::optional<Vec<CameraFrame>> unproject(const Optics& o, PixelPosition pixel) {
  const PixelPosition d = (pixel - principal_point(o)) * (1.0 / o.focal_length_px());
  if (o.projection == Projection::gnomonic) return unit(Vec<CameraFrame>{d.x_px, d.y_px, 1.0});
  const double r = std::hypot(d.x_px, d.y_px);
  const auto theta = theta_of(o.projection, r);
  if (!theta) return std::nullopt;
  const double s = r > 0.0 ? std::sin(*theta) / r : 1.0;
  return Vec<CameraFrame>{s * d.x_px, s * d.y_px, std::cos(*theta)};
}

double pixel_solid_angle_sr(const Optics& o, PixelPosition pixel) {
  const double f = o.focal_length_px();
  const PixelPosition d = pixel - principal_point(o);
  const auto theta = theta_of(o.projection, std::hypot(d.x_px, d.y_px) / f);
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
  return theta_of(o.projection, r).value_or(pi);
}

}  // namespace dmise
