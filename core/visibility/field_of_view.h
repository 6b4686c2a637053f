#pragma once
#include <array>

#include "core/frames/vec.h"
#include "core/optics/camera.h"

namespace dmise {

/// The directions that a camera's frame covers, and lower bounds of distances from them.
class FieldOfView {
 public:
  explicit FieldOfView(const Optics& optics);

  /// Whether light along `line` (any length > 0) hits the frame, edges included.
  bool contains(const Vec<CameraFrame>& line) const;

  /// Lower bound of the distance [m] of a position from the field of view; <= 0 if it may be
  /// inside. Changes by at most the motion of the position. Exact beside the edges of a gnomonic
  /// frame; for other projections it is that of the cone around the frame.
  double outside_m(const Vec<CameraFrame>& from_camera_m) const;

 private:
  Optics optics_;
  bool flat_ = false;                         // gnomonic: the edges are planes through the camera
  std::array<Vec<CameraFrame>, 4> outwards_;  // unit normals of those planes
  double cone_cos_ = 0.0, cone_sin_ = 0.0;    // half angle of the cone
  bool everything_ = false;                   // the cone is the whole sphere
};

/// Distance from a cone around `axis` (unit), <= 0 inside.
template <class F>
double outside_cone_m(const Vec<F>& from_apex_m, const Vec<F>& axis, double cos_half,
                      double sin_half) {
  const double along = dot(from_apex_m, axis);
  const double square = dot(from_apex_m, from_apex_m) - along * along;
  return std::sqrt(square > 0.0 ? square : 0.0) * cos_half - along * sin_half;
}

}  // namespace dmise
