#pragma once
#include <algorithm>

#include "sensors/render/tile_mesh.h"

namespace dmise {

/// The camera's mapping to clip space: linear, so that what lies behind the camera is clipped.
class ClipSpace {
 public:
  explicit ClipSpace(const TileScene& scene)
      : camera_(scene.camera), rotation_(scene.camera_from_body), object_m_(scene.object_m) {
    const double size = radius_m(*scene.mesh);
    near_ = 1e300;
    far_ = -1e300;
    for (const auto& v : scene.mesh->vertex_m) {
      const double z = (rotation_ * v + object_m_).z;
      near_ = std::min(near_, z);
      far_ = std::max(far_, z);
    }
    far_ += 0.01 * size;
    near_ = std::max(near_ - 0.01 * size, 1e-3 * size);
    far_ = std::max(far_, 2.0 * near_ * 1e-6 + near_);
    scale_ = 1.0 / std::max(norm(object_m_), size);
  }

  Vec<CameraFrame> place(const Vec<Body>& v) const { return rotation_ * v + object_m_; }
  double near_m() const { return near_; }

  void put(const Vec<CameraFrame>& p, TileVertex& out) const {
    const double columns = camera_.columns, rows = camera_.rows;
    const double x0 = 2.0 * (camera_.principal_x_px - camera_.left + 0.5) / columns - 1.0;
    const double y0 = 2.0 * (camera_.principal_y_px - camera_.top + 0.5) / rows - 1.0;
    out.clip[0] = float(x0 * p.z + 2.0 * camera_.focal_px / columns * p.x);
    out.clip[1] = float(y0 * p.z + 2.0 * camera_.focal_px / rows * p.y);
    out.clip[2] = float((far_ - p.z) * near_ / (far_ - near_));
    out.clip[3] = float(p.z);
    out.view[0] = float(-p.x * scale_);
    out.view[1] = float(-p.y * scale_);
    out.view[2] = float(-p.z * scale_);
  }

 private:
  TileCamera camera_;
  Rotation<CameraFrame, Body> rotation_;
  Vec<CameraFrame> object_m_;
  double near_ = 0, far_ = 0, scale_ = 1;
};

}  // namespace dmise
