#pragma once
#include <optional>

#include "core/base/pixel.h"
#include "core/products/frame_header.h"
#include "core/sky/air/refraction.h"

namespace dmise {

/// Normal of the ellipsoid at a ground sensor, unit: its geocentric direction rotated in the
/// meridian by the difference of geodetic and geocentric latitude (up to 0.19 deg). The meridian is
/// taken through the GCRS pole, 0.0026 rad off by 2026: 2 arcsec in the zenith. In space, away from
/// the Earth's centre.
Vec<Gcrs> zenith_of(const FrameHeader& header);

/// Refraction of a ground sensor, with the standard atmosphere if the header has none; empty in
/// space and if the frame was made without refraction.
std::optional<Refraction> refraction_of(const FrameHeader& header);

/// Atmospheric extinction of a source at `pixel` [mag]: the header's coefficient times the airmass
/// by Kasten & Young 1989 at the apparent elevation; 0 without a site.
double extinction_mag(const FrameHeader& header, PixelPosition pixel);

}  // namespace dmise
