#pragma once
#include <algorithm>
#include <cmath>

#include "sensors/render/tile_mesh.h"

namespace dmise {

/// The camera's mapping to clip space: linear, so that geometry behind the camera is clipped.
class ClipSpace {
 public:
  explicit ClipSpace(const TileScene& scene)
      : camera_from_body_(glm_of(scene.camera_from_body)), object_m_(glm_of(scene.object_m)) {
    const double size = radius_m(*scene.mesh);
    near_ = 1e300;
    far_ = -1e300;
    for (const auto& v : scene.mesh->vertex_m) {
      const double z = place(v).z;
      near_ = std::min(near_, z);
      far_ = std::max(far_, z);
    }
    far_ += 0.01 * size;
    const TileCamera& camera = scene.camera;
    const double columns = camera.columns, rows = camera.rows;
    // Nothing in the tile is nearer than the bounding box at its farthest corner.
    const auto farthest = [&](double first_px, double pixels, double principal_px) {
      return std::max(std::abs(first_px - principal_px),
                      std::abs(first_px + pixels - principal_px));
    };
    const double box_m =
        distance_from_box_m(*scene.mesh, scene.camera_from_body, scene.object_m) /
        std::hypot(1.0,
                   farthest(camera.left - 0.5, columns, camera.principal_x_px) / camera.focal_px,
                   farthest(camera.top - 0.5, rows, camera.principal_y_px) / camera.focal_px);
    near_ = std::max(near_ - 0.01 * size, std::min(1e-3 * size, 0.99 * box_m));
    far_ = std::max(far_, 2.0 * near_ * 1e-6 + near_);
    scale_ = 1.0 / std::max(glm::length(object_m_), size);

    clip_from_camera_ =
        glm::dmat3({2.0 * camera.focal_px / columns, 0, 0}, {0, 2.0 * camera.focal_px / rows, 0},
                   {2.0 * (camera.principal_x_px - camera.left + 0.5) / columns - 1.0,
                    2.0 * (camera.principal_y_px - camera.top + 0.5) / rows - 1.0, 1});
  }

  /// Position in camera axes [m].
  glm::dvec3 place(const Vec<Body>& v) const { return camera_from_body_ * glm_of(v) + object_m_; }
  double near_m() const { return near_; }

  void put(const glm::dvec3& p, TileVertex& out) const {
    const glm::dvec3 xyw = clip_from_camera_ * p;
    out.clip = {xyw.x, xyw.y, (far_ - p.z) * near_ / (far_ - near_), xyw.z};
    out.view = -p * scale_;
  }

 private:
  glm::dmat3 camera_from_body_;
  glm::dvec3 object_m_;
  glm::dmat3 clip_from_camera_;  // x, y and w; depth is not linear in them
  double near_ = 0, far_ = 0, scale_ = 1;
};

}  // namespace dmise
