#pragma once
#include <vector>

#include "core/detection/psf_shape.h"

namespace dmise {

/// All light of a point in units of that of a mixture with which `stars` were fitted, by its growth
/// with the distance: what pixels within ten widths have over the mixture is added, and beyond them
/// light falls as it does behind the aperture that explains the growth best, or by a power where
/// there are no dark rings. Wide Gaussians say little about either: they are fitted to a slope. An
/// error of the sky, which has of the stars' wings, is fitted, too. Seeing, lenses and apertures
/// without or with an obscuration come out to 0.5 %. 1 where that cannot be told.
double light_by_growth(const std::vector<ShapeStar>& stars, const PsfField& mixture);

}  // namespace dmise
