#pragma once
#include "core/base/image.h"
#include "core/base/parallel.h"
#include "sensors/pipeline/view.h"

namespace dmise {

/// Fills `image` with the expected electrons of the sky: uniform radiance at the zenith's
/// brightness, each pixel by its own solid angle; 0 below the apparent horizon of a ground sensor.
/// With the effect off, all zero. Solid angle and horizon are evaluated every 16 px and
/// interpolated (error below 1e-5 of the sky over a 90 deg field).
void fill_sky(const View& view, RateImage& image, Threads& threads);

}  // namespace dmise
