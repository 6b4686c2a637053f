#pragma once
#include <vector>

#include "core/detection/psf_shape.h"

namespace dmise {

/// All light of a point in units of that of a mixture with which `stars` were fitted, by its growth
/// with the distance: what pixels within ten widths have over the mixture is added, and beyond them
/// light falls by the power with which it does there. Wide Gaussians say little about either: they
/// are fitted to a slope. Seeing, lenses and apertures without or with a third of an obscuration
/// come out to 1 %. 1 where that cannot be told.
double light_by_growth(const std::vector<ShapeStar>& stars, const PsfField& mixture);

}  // namespace dmise
