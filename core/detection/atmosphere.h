#pragma once
#include "core/base/pixel.h"
#include "core/image/frame_header.h"

namespace dmise {

/// What the atmosphere took from a source at `pixel` [mag]: the header's extinction times the airmass
/// there, of Kasten & Young 1989; 0 without a site. The zenith is taken along the sensor's geocentric
/// position, up to 0.2 deg off: 2 mmag at an airmass of 2.
double extinction_mag(const FrameHeader& header, PixelPosition pixel);

}  // namespace dmise
