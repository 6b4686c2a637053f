#pragma once
#include <optional>
#include <vector>

#include "core/detection/light/trail_fit.h"

namespace dmise {

/// One star fitted as a trail of a Gaussian whose width is free.
struct StarWidth {
  Trail trail;
  double background_e = 0.0;
  double log_width = 0.0;  // logarithm of sigma_px without pixel
  double error = 0.0;      // 1 sigma of log_width
  double reduced_chi2 = 0.0;
  double chi2 = 0.0;
};

/// Least squares for place, flux, width and a constant background whose prior is 0 with
/// `background_sigma_e`. `width_px` is where the width starts. Empty if it does not converge, or to
/// no star: no flux, or narrower than 0.6 px FWHM as a hot pixel is.
std::optional<StarWidth> fit_star_width(const std::vector<FitPixel>& pixels, const Trail& start,
                                        double width_px, double background_sigma_e);

}  // namespace dmise
