#pragma once
#include "core/detection/detection.h"
#include "core/detection/scene.h"
#include "core/image/frame_header.h"

namespace dmise {

/// The detection that a source amounts to: pixels to directions, electrons to magnitudes, errors
/// with them. `id` and `index` are left to the caller.
///
/// covariance_px2 is of the centroid of light, from the fit. covariance_rad2 adds what one frame
/// can't tell: the centroid of a long streak is where the object was at mid exposure only if it
/// moved evenly. For uniform straight motion in space the two differ by tan(a) arc^2 / 12 along the
/// track, a the angle from closest approach; that with tan(a) = 1 is added as a standard deviation.
Detection describe(const Source& source, const FrameHeader& header);

}  // namespace dmise
