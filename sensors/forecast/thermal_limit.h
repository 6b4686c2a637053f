#pragma once
#include <optional>

#include "sensors/forecast/detection_limit.h"

namespace dmise {

/// Figures of a frame in a thermal band, at its centre. A flux density equivalent to noise (NEFD)
/// is that at the aperture of a point with the signal-to-noise ratio 1 in one exposure, by its fit:
/// E = noise sqrt(A) / (area x transmission x quantum efficiency x exposure), with A the inverse of
/// the sum of squares of its light's shares in the pixels.
struct ThermalLimit {
  double background_e_per_s = 0.0;     // electrons in a pixel, with dark current
  double fills_in_s = 0.0;             // a pixel, by the background alone
  double nefd_photons_per_s_m2 = 0.0;  // in the band
  double nefd_w_per_m2 = 0.0;          // flux at the band's centre
  double nefd_jy = 0.0;                // for a source with as much at every frequency
  double nefd_ab_mag = 0.0;
};

/// Empty in bands that are not thermal.
std::optional<ThermalLimit> thermal_limit(const View& view, const PixelBackground& background,
                                          double full_e, double sigma_px);

}  // namespace dmise
