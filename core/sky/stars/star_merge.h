#pragma once
#include "core/sky/stars/star_catalogue.h"

namespace dmise {

/// A star of `deeper` within this angle of another star is that star.
inline constexpr double same_star_rad = 2.4240684e-5;  // 5 arcsec

/// All stars of a catalogue, then those of a deeper one that are not in it. Both of one epoch.
StarCatalogue merge_stars(StarCatalogue stars, const StarCatalogue& deeper);

}  // namespace dmise
