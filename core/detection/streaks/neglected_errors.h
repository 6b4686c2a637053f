#pragma once
#include "core/detection/source/end_errors.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// Returns the error of a streak's end that is a step lost in noise, by the square of the SNR of
/// one pixel's length (Yao 1987, Annals of Statistics 15, 1321).
double end_error_px(double snr2_per_px);

/// Adds to a covariance the errors that the curvature of chi2 at the fit does not show.
///  - Ends that are faint in each pixel: `ends` replaces all covariances of the place along the
///    line, flux, length and slope. Null: ends are as sharp as chi2 says.
///  - The next order of the expansion in 1 / SNR: all but the flux of a streak times
///    1 + 10 / SNR^2. A parameter alone would have 3 / SNR^2, by the noise of the curvature at the
///    fit less its correlation with the flux; each of the 4 to 6 others takes its share of noise
///    into the flux, by which the fit's covariance becomes too small, and turns the gradient.
///    Places across of 27,000 fits to lines of 8 to 40 px and SNR 8 to 14 have 9.5 in the mean.
///  - Brightness: a short streak is fitted as even, and a change of 0.7 % from its middle to an end
///    displaces it. Model: 0.001 px. Both sizes are what the directions of 475 bright streaks in
///    twilight lacked (`FisheyeDirections`).
void add_neglected_errors(Source& source, const EndErrors* ends);

/// Adds to the variance of a streak's light that of both ends as steps in noise: 26 / SNR^4 px^2 by
/// the SNR of a pixel's length, times exp(-sigma_px SNR^2 / 2) by the blur.
void add_steps_at_ends(Source& source, double sigma_px);

/// Adds to the variance of a streak along columns what offsets of whole columns make of its light.
void add_column_noise(Source& source, double column_noise_e, double sigma_px);

}  // namespace dmise
