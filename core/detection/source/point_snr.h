#pragma once
#include "core/base/image.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// SNR of a point source in the middle of each pixel.
using PointSnrImage = Image<float, struct PointSnrCarrier>;

/// Returns a frame through the matched filter of points, in units of its noise. Unlike in a
/// `FilteredFrame` values are neither rounded nor clipped. Pixels without a value count as
/// background.
PointSnrImage point_snr(const Scene& scene);

}  // namespace dmise
