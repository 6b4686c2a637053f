#include "core/optics/projection.h"

#include <algorithm>
#include <array>

#include "core/base/units.h"

namespace dmise {
PixelPosition principal_point(const Optics& o) {
  return {0.5 * (o.columns - 1), 0.5 * (o.rows - 1)};
}

bool in_frame(const Optics& o, PixelPosition at, double margin_px) {
  const double edge_px = 0.5 + margin_px;
  return at.x_px > -edge_px && at.y_px > -edge_px && at.x_px < o.columns - 1 + edge_px &&
         at.y_px < o.rows - 1 + edge_px;
}

std::optional<PixelPosition> project(const Optics& o, const Vec<CameraFrame>& direction) {
  const Vec<CameraFrame> v = unit(direction);
  const auto image = o.projection.image_of(v.x, v.y, v.z);
  if (!image) return std::nullopt;
  const double f = o.focal_length_px();
  return principal_point(o) + PixelPosition{f * (*image)[0], f * (*image)[1]};
}

std::optional<Vec<CameraFrame>> unproject(const Optics& o, PixelPosition pixel) {
  const PixelPosition d = (pixel - principal_point(o)) * (1.0 / o.focal_length_px());
  const auto v = o.projection.direction_of(d.x_px, d.y_px);
  if (!v) return std::nullopt;
  return Vec<CameraFrame>{(*v)[0], (*v)[1], (*v)[2]};
}

double pixel_solid_angle_sr(const Optics& o, PixelPosition pixel) {
  const PixelPosition d = pixel - principal_point(o);
  return o.projection.pixel_solid_angle_sr(d.x_px, d.y_px, o.focal_length_px());
}

namespace {

/// Largest angle from the boresight [rad] along the frame's rim; empty if a sampled place images no
/// direction.
std::optional<double> rim_angle_rad(const Optics& o) {
  constexpr int steps = 16;  // along each side
  const double x = 0.5 * o.columns / o.focal_length_px(), y = 0.5 * o.rows / o.focal_length_px();
  double most = 0.0;
  for (int i = -steps; i <= steps; ++i)
    for (const auto& [u, v] : {std::array{x, y * i / steps}, std::array{-x, y * i / steps},
                               std::array{x * i / steps, y}, std::array{x * i / steps, -y}}) {
      const auto angle = o.projection.axis_angle_rad(u, v);
      if (!angle) return std::nullopt;
      most = std::max(most, *angle);
    }
  return most;
}

}  // namespace

double half_diagonal_rad(const Optics& o) { return rim_angle_rad(o).value_or(pi); }

double field_across_rad(const Optics& o, double x_px, double y_px) {
  const double x = x_px / o.focal_length_px(), y = y_px / o.focal_length_px();
  return o.projection.axis_angle_rad(x, y).value_or(pi) +
         o.projection.axis_angle_rad(-x, -y).value_or(pi);
}

std::optional<double> fold_in_frame_rad(const Optics& o) {
  const auto fold = o.projection.fold_rad();
  return fold && !rim_angle_rad(o) ? fold : std::nullopt;
}

}  // namespace dmise
