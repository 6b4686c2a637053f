#pragma once
#include <vector>

#include "core/detection/light/psf_shape.h"

namespace dmise {

/// Measures the ellipticity of the PSF from all stars together, with each star's flux, place,
/// width and background free, and sets it in `field` where it is significant and above 0.02.
void fit_psf_ellipse(const std::vector<ShapeStar>& stars, PsfField& field);

}  // namespace dmise
