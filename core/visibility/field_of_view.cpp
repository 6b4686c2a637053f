#include "core/visibility/field_of_view.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/optics/projection.h"

namespace dmise {

FieldOfView::FieldOfView(const Optics& optics)
    : optics_(optics), flat_(optics.projection == Projection::gnomonic) {
  if (flat_) {
    const double f = optics.focal_length_px();
    const double x = 0.5 * optics.columns / f, y = 0.5 * optics.rows / f;
    outwards_ = {unit(Vec<CameraFrame>{1, 0, -x}), unit(Vec<CameraFrame>{-1, 0, -x}),
                 unit(Vec<CameraFrame>{0, 1, -y}), unit(Vec<CameraFrame>{0, -1, -y})};
    return;
  }
  const double half = half_diagonal_rad(optics);
  everything_ = half >= pi;
  cone_cos_ = std::cos(half);
  cone_sin_ = std::sin(half);
}

bool FieldOfView::contains(const Vec<CameraFrame>& line) const {
  if (flat_) return outside_m(line) <= 0.0;
  const auto pixel = project(optics_, line);
  return pixel && pixel->x_px >= -0.5 && pixel->y_px >= -0.5 &&
         pixel->x_px <= optics_.columns - 0.5 && pixel->y_px <= optics_.rows - 0.5;
}

double FieldOfView::outside_m(const Vec<CameraFrame>& from_camera_m) const {
  if (flat_) {
    double most = dot(outwards_[0], from_camera_m);
    for (int k = 1; k < 4; ++k) most = std::max(most, dot(outwards_[k], from_camera_m));
    return most;
  }
  if (everything_) return 0.0;
  return outside_cone_m(from_camera_m, Vec<CameraFrame>{0, 0, 1}, cone_cos_, cone_sin_);
}

}  // namespace dmise
