#pragma once
#include <vector>

#include "core/detection/light/psf.h"
#include "core/detection/light/trail_fit.h"

namespace dmise {

/// A star as fitted so far, and the pixels from which the shape is measured.
struct ShapeStar {
  Trail trail;
  double background_e = 0.0, background_sigma_e = 1.0;  // the prior of a constant background
  std::vector<FitPixel> pixels;
};

/// Measures the weights of the Gaussians that make up the PSF, from all stars together, with each
/// star's flux, place and background free. Leaves `field`, which has the width of one Gaussian, as
/// it is where a mixture does not fit significantly better.
void fit_psf_shape(std::vector<ShapeStar> stars, PsfField& field);

}  // namespace dmise
