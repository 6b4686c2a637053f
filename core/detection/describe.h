#pragma once
#include "core/detection/scene.h"
#include "core/products/detection.h"
#include "core/products/frame_header.h"

namespace dmise {

/// The detection that a source amounts to: pixels to directions, electrons to magnitudes, errors
/// with them. `id` and `index` are left to the caller.
///
/// x_px, y_px and covariance_px2 are of the centroid of light, from the fit. Directions are those
/// of the fitted line's point where the object was at mid exposure (core/detection/mid_exposure.h):
/// a bend lays it off the centroid, a brightness that changes moves the centroid along.
/// covariance_rad2 adds what one frame can't tell of that, and the error of the WCS.
Detection describe(const Source& source, const FrameHeader& header);

}  // namespace dmise
