#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "sensors/render/renderer.h"

namespace dmise {

TileCamera tile_around(const Mesh& mesh, const Rotation<CameraFrame, Body>& camera_from_body,
                       const Vec<CameraFrame>& object_m, const TileCamera& frame) {
  TileCamera tile = frame;
  double x0 = 1e300, y0 = 1e300, x1 = -1e300, y1 = -1e300;
  bool before = false, behind = false;
  for (const auto& vertex : mesh.vertex_m) {
    const Vec<CameraFrame> p = camera_from_body * vertex + object_m;
    if (!(p.z > 0.0)) {
      behind = true;
      continue;
    }
    before = true;
    const double x = frame.principal_x_px + frame.focal_px * p.x / p.z;
    const double y = frame.principal_y_px + frame.focal_px * p.y / p.z;
    x0 = std::min(x0, x);
    y0 = std::min(y0, y);
    x1 = std::max(x1, x);
    y1 = std::max(y1, y);
  }
  const double right = frame.left + frame.columns - 1.0, bottom = frame.top + frame.rows - 1.0;
  if (!before) {
    tile.columns = tile.rows = 0;
    return tile;
  }
  if (!behind) {
    // A pixel spans -0.5 to 0.5 about its centre.
    const auto clamped = [](double v, double least, double most) {
      return int(std::clamp(v, least, most));
    };
    tile.left = clamped(std::floor(x0 + 0.5), frame.left, right + 1);
    tile.top = clamped(std::floor(y0 + 0.5), frame.top, bottom + 1);
    tile.columns = clamped(std::floor(x1 + 0.5), frame.left - 1.0, right) - tile.left + 1;
    tile.rows = clamped(std::floor(y1 + 0.5), frame.top - 1.0, bottom) - tile.top + 1;
  }
  if (tile.columns <= 0 || tile.rows <= 0) tile.columns = tile.rows = 0;
  return tile;
}

double distance_from_box_m(const Mesh& mesh, const Rotation<CameraFrame, Body>& camera_from_body,
                           const Vec<CameraFrame>& object_m) {
  const Vec<Body> camera = camera_from_body.inverse() * -object_m;
  Vec<Body> least = mesh.vertex_m.at(0), most = least;
  for (const auto& v : mesh.vertex_m) {
    least = {std::min(least.x, v.x), std::min(least.y, v.y), std::min(least.z, v.z)};
    most = {std::max(most.x, v.x), std::max(most.y, v.y), std::max(most.z, v.z)};
  }
  const auto beyond = [](double at, double low, double high) {
    return std::max({0.0, low - at, at - high});
  };
  return norm(Vec<Body>{beyond(camera.x, least.x, most.x), beyond(camera.y, least.y, most.y),
                        beyond(camera.z, least.z, most.z)});
}

void check_outside(const Mesh& mesh, const Rotation<CameraFrame, Body>& camera_from_body,
                   const Vec<CameraFrame>& object_m) {
  if (!(distance_from_box_m(mesh, camera_from_body, object_m) > 0.0))
    throw Error("camera is inside the object's bounding box");
}

}  // namespace dmise
