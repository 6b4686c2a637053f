#pragma once
#include <span>

#include "core/astrometry/plate_frame.h"
#include "core/astrometry/star_patterns.h"

namespace dmise {

/// Finds the plate of a frame from its sources (in any order; those with numbers that are not
/// finite or out of the frame are ignored). With a believed pointing or axis the sky around
/// it is searched, else all of it. A `cache` of the sky's catalogue saves the next blind solution
/// time. Deterministic. Throws `Error` with the reason if there is none.
PlateSolution solve_plate(std::span<const PlateSource> sources, const PlateHint& hint,
                          const PlateSky& sky, const PlateSearch& search = {},
                          PatternCache* cache = nullptr);

}  // namespace dmise
