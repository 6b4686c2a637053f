#pragma once
#include <functional>
#include <optional>

#include "core/base/pixel.h"
#include "core/detection/detection.h"

namespace dmise {

/// The true mapping of an image: the ICRS direction (any length > 0) seen by a pixel, with
/// everything that bends light on its way (refraction, aberration); nothing where the pixel sees no
/// sky.
using SkyOfPixel = std::function<std::optional<Vec<Gcrs>>(PixelPosition)>;

/// Fits TAN + SIP to `sky` over the frame by least squares in pixels on a grid of Chebyshev points
/// (dense at the edges, so that the largest residual stays near the rms). `order` 0..5 of the
/// polynomials; 0 fits a plain TAN. `rms_px` and `max_px` of the result compare `wcs_direction`
/// with `sky` on a finer grid. What lies more than 60 deg from the reference is left out of fit and
/// residuals: TAN can't hold a whole fisheye frame. Throws `Error` when fewer pixels than
/// unknowns see sky near the frame's centre.
Wcs fit_wcs(int columns, int rows, const SkyOfPixel& sky, int order);

}  // namespace dmise
