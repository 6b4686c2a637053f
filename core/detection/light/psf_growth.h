#pragma once
#include <vector>

#include "core/detection/light/psf_shape.h"

namespace dmise {

/// Returns all light of a point source over that of the mixture with which `stars` were fitted, by
/// its curve of growth. Within ten widths it adds the light of pixels over the mixture's; farther
/// out, light falls as behind the aperture that fits the curve best, or by a power of the distance
/// where there are no dark rings. The mixture's wide Gaussians are no measure of this light. The
/// error of the sky, which contains some light of the stars' wings, is fitted too. Right to 0.5 %
/// for seeing, lenses and apertures with and without an obscuration; 1 where it cannot be measured.
double light_by_growth(const std::vector<ShapeStar>& stars, const PsfField& mixture);

}  // namespace dmise
