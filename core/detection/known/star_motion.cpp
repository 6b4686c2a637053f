#include "core/detection/known/star_motion.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

/// Turns a camera by a rotation vector in its axes.
Quaternion turned(const Quaternion& camera, double x_rad, double y_rad) {
  const double half = 0.5 * std::hypot(x_rad, y_rad);
  if (!(half > 0)) return camera;
  const double share = std::sin(half) / (2 * half);
  const Quaternion by{std::cos(half), share * x_rad, share * y_rad, 0.0};
  return quaternion_of(rotation_of<CameraFrame, CameraFrame>(by) *
                       rotation_of<CameraFrame, Gcrs>(camera));
}

}  // namespace

StarMotion::StarMotion(const FrameHeader& header, int columns, int rows)
    : projection_(header.projection),
      focal_length_px_(header.focal_length_px),
      centre_{(columns - 1) / 2.0, (rows - 1) / 2.0},
      down_(header.mirrored ? -1.0 : 1.0) {
  const auto gcrs_from_middle =
      rotation_of<CameraFrame, Gcrs>(header.camera_from_gcrs[1]).inverse();
  start_from_middle_ =
      rotation_of<CameraFrame, Gcrs>(header.camera_from_gcrs[0]) * gcrs_from_middle;
  end_from_middle_ = rotation_of<CameraFrame, Gcrs>(header.camera_from_gcrs[2]) * gcrs_from_middle;
}

std::optional<Vec<CameraFrame>> StarMotion::direction(PixelPosition pixel) const {
  const PixelPosition d = (pixel - centre_) * (1.0 / focal_length_px_);
  const auto v = projection_.direction_of(d.x_px, down_ * d.y_px);
  if (!v) return std::nullopt;
  return Vec<CameraFrame>{(*v)[0], (*v)[1], (*v)[2]};
}

std::optional<PixelPosition> StarMotion::pixel(const Vec<CameraFrame>& direction) const {
  const auto image = projection_.image_of(direction.x, direction.y, direction.z);
  if (!image) return std::nullopt;
  return centre_ + PixelPosition{(*image)[0], down_ * (*image)[1]} * focal_length_px_;
}

PixelPosition StarMotion::trail_at(PixelPosition at) const {
  const auto middle = direction(at);
  if (!middle) return {};
  const auto start = pixel(start_from_middle_ * *middle);
  const auto end = pixel(end_from_middle_ * *middle);
  if (!start || !end) return {};
  const PixelPosition trail = *end - *start;
  return std::isfinite(trail.x_px + trail.y_px) ? trail : PixelPosition{};
}

std::array<PixelPosition, 9> StarMotion::trails_over_frame() const {
  std::array<PixelPosition, 9> trails;
  for (std::size_t i = 0; i < trails.size(); ++i)
    trails[i] = trail_at({double(i % 3) * centre_.x_px, double(i / 3) * centre_.y_px});
  return trails;
}

double StarMotion::longest_trail_px() const {
  double longest = 0.0;
  for (const PixelPosition& t : trails_over_frame())
    longest = std::max(longest, std::hypot(t.x_px, t.y_px));
  return longest;
}

void set_even_drift(FrameHeader& header, PixelPosition trail) {
  const double f = header.focal_length_px, down = header.mirrored ? -1.0 : 1.0;
  const double x_rad = -down * trail.y_px / (2 * f), y_rad = trail.x_px / (2 * f);
  const Quaternion middle = header.camera_from_gcrs[1];
  header.camera_from_gcrs[0] = turned(middle, -x_rad, -y_rad);
  header.camera_from_gcrs[2] = turned(middle, x_rad, y_rad);
}

}  // namespace dmise
