#include "sensors/outlook/camera_figures.h"

#include <cmath>

#include "core/base/units.h"
#include "core/optics/projection.h"

namespace dmise {
namespace {

/// Twice the angle from the boresight of a point (x, y) [px] from the centre.
double across_rad(const Optics& optics, double x_px, double y_px) {
  const PixelPosition centre = principal_point(optics);
  const auto direction = unproject(optics, {centre.x_px + x_px, centre.y_px + y_px});
  if (!direction) return 2 * pi;
  return 2 * std::atan2(std::hypot(direction->x, direction->y), direction->z);
}

}  // namespace

CameraFigures camera_figures(const Optics& optics) {
  const double x_px = optics.columns / 2.0, y_px = optics.rows / 2.0;
  return {.width_rad = across_rad(optics, x_px, 0.0),
          .height_rad = across_rad(optics, 0.0, y_px),
          .diagonal_rad = across_rad(optics, x_px, y_px),
          .pixel_rad = optics.pixel_angle_rad(),
          .f_number = optics.f_number()};
}

}  // namespace dmise
