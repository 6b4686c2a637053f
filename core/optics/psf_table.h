#pragma once
#include <array>
#include <vector>

#include "core/base/units.h"
#include "core/optics/camera.h"

namespace dmise {

/// Narrower Gaussians are deposited with this width; it moves light by less than 0.1 px.
inline constexpr double narrowest_sigma_px = 0.02;
inline constexpr double widest_sigma_px = 500.0;  // that is drawn

/// A round Gaussian integrated over square pixels, tabulated over the sub-pixel position: pixels
/// are separable, so one axis is enough. With c the centre on an axis, `weights` has for each phase
/// c - floor(c) the fractions of the `size` pixels from floor(c) + first on. The fractions of a
/// phase sum to 1: light beyond 5 sigma is added to the outermost pixels. Linear interpolation
/// between phases has an error below 2e-7.
struct PsfTable {
  double sigma_px = 0.0;
  int phases = 0;              // intervals
  int first = 0;               // where the window begins, relative to floor(c); <= 0
  int size = 0;                // pixels in the window
  int stride = 0;              // length of a row of `weights`, a multiple of 8; the rest is 0
  std::vector<float> weights;  // (phases + 1) x stride
  /// Sum and first moment, from the window's first pixel on, of each phase.
  std::vector<std::array<double, 2>> whole;
};

/// `sigma_px` must be 0 to `widest_sigma_px`; throws `Error` otherwise.
PsfTable make_psf_table(double sigma_px);

/// Standard deviation of the Gaussian with the half width at half maximum of a circular aperture's
/// Airy pattern, 0.514 lambda / D [px], ignoring the obscuration.
double diffraction_sigma_px(const Optics& optics, double wavelength_m);

/// Width of the camera's PSF before pixel integration: `psf_fwhm_px` and diffraction in quadrature.
double psf_sigma_px(const Optics& optics, double wavelength_m);

}  // namespace dmise
