#pragma once
#include <optional>

#include "core/base/pixel.h"
#include "core/frames/vec.h"
#include "core/optics/camera.h"

// Maps directions to detector pixels with the camera's `Projection`, with the boresight at the
// image's centre, ((columns - 1) / 2, (rows - 1) / 2).
namespace dmise {

PixelPosition principal_point(const Optics& optics);

/// Whether a place is on a pixel of the frame, or less than `margin_px` beside it.
bool in_frame(const Optics& optics, PixelPosition at, double margin_px = 0.0);

/// Pixel of a direction (any length > 0), also outside the frame. Empty where the projection has no
/// image: 90 deg and more from the boresight for the gnomonic, exactly behind for a fisheye.
std::optional<PixelPosition> project(const Optics& optics, const Vec<CameraFrame>& direction);

/// Direction of a pixel, a unit vector. Empty where no direction is imaged: beyond pi f
/// (equidistant) or 2 f (equisolid) from the principal point.
std::optional<Vec<CameraFrame>> unproject(const Optics& optics, PixelPosition pixel);

/// Solid angle of a pixel [sr], from the projection's area scale at its centre; 0 where no
/// direction is imaged. Relative error of using the centre: about (pixel angle)^2.
double pixel_solid_angle_sr(const Optics& optics, PixelPosition pixel);

/// Field along a line through the centre, from (-x, -y) to (x, y) pixels from it [rad, 0..2 pi]:
/// the sum of its ends' angles from the boresight. An end where no direction is imaged counts as
/// pi.
double field_across_rad(const Optics& optics, double x_px, double y_px);

/// Angle from the boresight of the farthest point of the frame [rad, 0..pi].
double half_diagonal_rad(const Optics& optics);

/// Angle from the boresight [rad] at which the projection folds back, if that is within the frame.
std::optional<double> fold_in_frame_rad(const Optics& optics);

}  // namespace dmise
