#include "sensors/light/shape_window.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/optics/projection.h"

namespace dmise {
namespace {

constexpr double fine_side_px = 512;  // tiles below this are drawn finer than the camera's pixels
constexpr double usual_fineness = 4;  // but no finer
constexpr double min_side_px = 32;    // than makes a tile of this
constexpr double widest_rad = 1.2;    // half angle of a tile about the object

/// Axes about `direction` whose x is nearest to the camera's.
Rotation<CameraFrame, TileAxes> axes_about(const Vec<CameraFrame>& direction) {
  const Vec<CameraFrame> aside =
      std::abs(direction.x) < 0.9 ? Vec<CameraFrame>{1, 0, 0} : Vec<CameraFrame>{0, 0, -1};
  const Vec<CameraFrame> y = unit(cross(direction, aside)), x = cross(y, direction);
  return {{{{x.x, y.x, direction.x}, {x.y, y.y, direction.y}, {x.z, y.z, direction.z}}}};
}

/// Camera pixels per radian about a direction, the most of any way.
double pixels_per_rad(const Optics& optics, const Rotation<CameraFrame, TileAxes>& axes) {
  constexpr double step_rad = 1e-4;
  const auto middle = project(optics, axes * Vec<TileAxes>{0, 0, 1});
  double most = optics.focal_length_px();
  for (const Vec<TileAxes> to : {Vec<TileAxes>{step_rad, 0, 1}, Vec<TileAxes>{0, step_rad, 1}})
    if (const auto place = project(optics, axes * to); place && middle)
      most = std::max(
          most, std::hypot(place->x_px - middle->x_px, place->y_px - middle->y_px) / step_rad);
  return most;
}

/// Part of the plane at unit distance before the tile's camera.
struct PlanePart {
  double left, top, right, bottom;
};

/// What the frame and `margin_px` about it see; nothing where their rim is not all before the
/// tile's camera.
std::optional<PlanePart> seen_part(const Optics& optics,
                                   const Rotation<TileAxes, CameraFrame>& tile_from_camera,
                                   double margin_px) {
  constexpr int steps = 16;       // along each side
  constexpr double bulge = 0.02;  // share of the box that a curved side may bulge between steps
  constexpr double min_z = 0.05;
  const double x0 = -0.5 - margin_px, y0 = -0.5 - margin_px;
  const double wide = optics.columns + 2 * margin_px, high = optics.rows + 2 * margin_px;
  PlanePart w{1e300, 1e300, -1e300, -1e300};
  for (int i = 0; i <= steps; ++i) {
    const double s = double(i) / steps;
    for (const PixelPosition rim : {PixelPosition{x0 + s * wide, y0},
                                    {x0 + s * wide, y0 + high},
                                    {x0, y0 + s * high},
                                    {x0 + wide, y0 + s * high}}) {
      const auto direction = unproject(optics, rim);
      if (!direction) return std::nullopt;
      const Vec<TileAxes> d = tile_from_camera * *direction;
      if (!(d.z > min_z)) return std::nullopt;
      w = {std::min(w.left, d.x / d.z), std::min(w.top, d.y / d.z), std::max(w.right, d.x / d.z),
           std::max(w.bottom, d.y / d.z)};
    }
  }
  const double x = bulge * (w.right - w.left), y = bulge * (w.bottom - w.top);
  return PlanePart{w.left - x, w.top - y, w.right + x, w.bottom + y};
}

/// Pixels of a tile for each of the camera's, along a side, for what is `side_px` of those wide.
int fineness(double side_px) {
  const double fine = std::min(usual_fineness, fine_side_px / side_px);
  return int(std::clamp(std::max(fine, std::ceil(min_side_px / side_px)), 1.0, 1024.0));
}

double side_of(const TileCamera& camera) { return std::max({1, camera.columns, camera.rows}); }

/// The camera's own pixels, `fine` a side of each.
TileCamera own_pixels(const Optics& optics, double margin_px, int fine) {
  const PixelPosition principal = principal_point(optics);
  const int margin = int(std::ceil(margin_px));
  return {.focal_px = optics.focal_length_px() * fine,
          .principal_x_px = (principal.x_px + 0.5) * fine - 0.5,
          .principal_y_px = (principal.y_px + 0.5) * fine - 0.5,
          .left = -margin * fine,
          .top = -margin * fine,
          .columns = (optics.columns + 2 * margin) * fine,
          .rows = (optics.rows + 2 * margin) * fine};
}

/// Pixels about the object's direction.
TileCamera pixels_about(const PlanePart& part, double focal_px) {
  const auto below = [&](double at) { return int(std::floor(at * focal_px)); };
  TileCamera camera{.focal_px = focal_px, .left = below(part.left), .top = below(part.top)};
  camera.columns = below(part.right) + 2 - camera.left;
  camera.rows = below(part.bottom) + 2 - camera.top;
  return camera;
}

}  // namespace

ShapeWindow window_on(const Optics& optics, const Mesh& mesh, const ShapeSnapshot& snapshot,
                      double margin_px) {
  const bool gnomonic = optics.projection == Projection::gnomonic;
  ShapeWindow window;
  if (!gnomonic) window.camera_from_tile = axes_about(snapshot.direction);
  const auto tile_from_camera = window.camera_from_tile.inverse();
  const auto tile_from_body =
      tile_from_camera * snapshot.camera_from_gcrs * snapshot.pose.gcrs_from_body;
  const Vec<TileAxes> object_m = tile_from_camera * snapshot.direction * snapshot.pose.range_m;
  window.tile_from_body.m = tile_from_body.m;
  window.object_m = {object_m.x, object_m.y, object_m.z};
  const auto around = [&](const TileCamera& frame) {
    return frame.columns > 0 && frame.rows > 0
               ? tile_around(mesh, window.tile_from_body, window.object_m, frame)
               : TileCamera{};
  };
  const double ratio = snapshot.shape->radius_m / snapshot.pose.range_m;
  if (gnomonic) {
    const double sphere_px = std::max(1e-3, 2.0 * ratio * optics.focal_length_px());
    const int fine =
        fineness(std::min(sphere_px, side_of(around(own_pixels(optics, margin_px, 1)))));
    window.camera = around(own_pixels(optics, margin_px, fine));
    window.pixel_side_px = 1.0 / fine;
    return window;
  }
  const double reach = std::tan(ratio < 0.9 ? std::min(widest_rad, std::asin(ratio)) : widest_rad);
  PlanePart part{-reach, -reach, reach, reach};
  if (const auto seen = seen_part(optics, tile_from_camera, margin_px))
    part = {std::max(part.left, seen->left), std::max(part.top, seen->top),
            std::min(part.right, seen->right), std::min(part.bottom, seen->bottom)};
  if (!(part.right > part.left && part.bottom > part.top)) return window;
  const double per_rad = pixels_per_rad(optics, window.camera_from_tile);
  window.camera = around(pixels_about(part, per_rad));
  if (window.camera.columns > 0)
    window.camera = around(pixels_about(
        part, per_rad * fineness(std::min(2.0 * ratio * per_rad, side_of(window.camera)))));
  return window;
}

}  // namespace dmise
