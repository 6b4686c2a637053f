#include "sensors/forecast/camera_figures.h"

#include "core/optics/projection.h"

namespace dmise {

CameraFigures camera_figures(const Optics& optics) {
  const double x_px = optics.columns / 2.0, y_px = optics.rows / 2.0;
  return {.width_rad = field_across_rad(optics, x_px, 0.0),
          .height_rad = field_across_rad(optics, 0.0, y_px),
          .diagonal_rad = field_across_rad(optics, x_px, y_px),
          .pixel_rad = optics.pixel_angle_rad(),
          .f_number = optics.f_number()};
}

}  // namespace dmise
