#pragma once
#include "core/optics/camera.h"

namespace dmise {

/// Field of view and scale of a camera, from edge to edge of the outermost pixels.
struct CameraFigures {
  double width_rad = 0.0, height_rad = 0.0;  // through the boresight, along columns and rows
  double diagonal_rad = 0.0;                 // through the boresight, from corner to corner
  double pixel_rad = 0.0;                    // at the boresight
  double f_number = 0.0;
};

/// Fields are up to 360 deg if the image is smaller than the frame.
CameraFigures camera_figures(const Optics& optics);

}  // namespace dmise
