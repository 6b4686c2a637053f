#pragma once
#include <optional>

#include "core/base/pixel.h"
#include "core/products/frame_header.h"
#include "core/sky/refraction.h"

namespace dmise {

/// Normal of the ellipsoid at a ground sensor, unit: its geocentric direction turned in the
/// meridian by what geodetic and geocentric latitude differ (up to 0.19 deg). The meridian's plane
/// is that of the GCRS pole, 0.0026 rad off by 2026: 2 arcsec of the zenith. In space away from
/// the Earth's centre.
Vec<Gcrs> zenith_of(const FrameHeader& header);

/// That of a ground sensor's air, of the standard atmosphere where the header does not say; none
/// in space and where the frame was made without.
std::optional<Refraction> refraction_of(const FrameHeader& header);

/// What the atmosphere took from a source at `pixel` [mag]: the header's extinction times the
/// airmass of Kasten & Young 1989 at the apparent elevation; 0 without a site.
double extinction_mag(const FrameHeader& header, PixelPosition pixel);

}  // namespace dmise
