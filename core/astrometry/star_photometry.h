#pragma once
#include <optional>

#include "core/astrometry/measured_stars.h"
#include "core/astrometry/plate_frame.h"
#include "core/astrometry/zero_point.h"
#include "core/image/fits_file.h"

namespace dmise {

/// Zero point of a frame from the catalogue's stars that its plate shows. Stars take part by the
/// light that the catalogue leads to expect, never by the light measured, which would select those
/// that noise brightens; variable stars, and stars on which others shine, are left out, the light
/// that a lens with a table loses is added. Empty without an exposure or a star.
std::optional<ZeroPoint> zero_point_of(const Frame& frame, const PlateSolution& plate,
                                       const MeasuredStars& light, const PlateSky& sky);

}  // namespace dmise
