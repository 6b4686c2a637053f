#include "core/detection/star_motion.h"

#include <cmath>

#include "core/base/units.h"

namespace dmise {

StarMotion::StarMotion(const FrameHeader& header, int columns, int rows)
    : projection_(header.projection),
      focal_length_px_(header.focal_length_px),
      centre_{(columns - 1) / 2.0, (rows - 1) / 2.0} {
  const auto gcrs_from_middle = rotation_of<CameraFrame, Gcrs>(header.camera_from_gcrs[1]).inverse();
  start_from_middle_ = rotation_of<CameraFrame, Gcrs>(header.camera_from_gcrs[0]) * gcrs_from_middle;
  end_from_middle_ = rotation_of<CameraFrame, Gcrs>(header.camera_from_gcrs[2]) * gcrs_from_middle;
}

std::optional<Vec<CameraFrame>> StarMotion::direction(PixelPosition pixel) const {
  const PixelPosition d = (pixel - centre_) * (1.0 / focal_length_px_);
  const double r = std::hypot(d.x_px, d.y_px);
  double theta_rad = 0.0;
  switch (projection_) {
    case Projection::gnomonic:
      theta_rad = std::atan(r);
      break;
    case Projection::equidistant:
      theta_rad = r;
      break;
    case Projection::equisolid:
      if (r > 2) return std::nullopt;
      theta_rad = 2 * std::asin(r / 2);
      break;
    case Projection::stereographic:
      theta_rad = 2 * std::atan(r / 2);
      break;
  }
  if (theta_rad >= pi) return std::nullopt;
  const double across = r > 0 ? std::sin(theta_rad) / r : 1.0;
  return Vec<CameraFrame>{d.x_px * across, d.y_px * across, std::cos(theta_rad)};
}

std::optional<PixelPosition> StarMotion::pixel(const Vec<CameraFrame>& direction) const {
  const double across = std::hypot(direction.x, direction.y);
  const double theta_rad = std::atan2(across, direction.z);
  double r = 0.0;
  switch (projection_) {
    case Projection::gnomonic:
      if (direction.z <= 0) return std::nullopt;
      r = std::tan(theta_rad);
      break;
    case Projection::equidistant:
      r = theta_rad;
      break;
    case Projection::equisolid:
      r = 2 * std::sin(theta_rad / 2);
      break;
    case Projection::stereographic:
      if (theta_rad >= pi) return std::nullopt;
      r = 2 * std::tan(theta_rad / 2);
      break;
  }
  const double scale = across > 0 ? focal_length_px_ * r / across : focal_length_px_;
  return PixelPosition{centre_.x_px + scale * direction.x, centre_.y_px + scale * direction.y};
}

PixelPosition StarMotion::trail_at(PixelPosition at) const {
  const auto middle = direction(at);
  if (!middle) return {};
  const auto start = pixel(start_from_middle_ * *middle);
  const auto end = pixel(end_from_middle_ * *middle);
  if (!start || !end) return {};
  return *end - *start;
}

}  // namespace dmise
