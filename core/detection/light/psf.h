#pragma once
#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/pixel.h"

namespace dmise {

/// Light of a point source over pixels: concentric Gaussians. Their weights sum to the share of the
/// light that they describe, 1 less the light far out; some may be negative, as where diffraction
/// leaves dark rings. The variance of each includes the pixel's, 1/12 px^2.
struct Psf {
  struct Part {
    double weight = 1.0, sigma_px = 1.0;
  };
  static constexpr std::size_t most = 8;

  std::array<Part, most> parts{};
  std::size_t count = 1;
  // Ellipticity: relative change of the variance without pixel along x, and along the diagonal;
  // across them it is the opposite.
  double along_x = 0.0, along_diagonal = 0.0;

  Psf(double sigma_px = 1.0) { parts[0].sigma_px = sigma_px; }  // one Gaussian

  /// Width of the Gaussian with the same sum of squares, and so with the same matched-filter SNR.
  double equivalent_sigma_px() const;
};

/// Variance that pixels add to a Gaussian [px^2].
inline constexpr double pixel_variance_px2 = 1.0 / 12;

/// Standard deviation of a Gaussian of `sigma_px` and pixels together.
double with_pixel(double sigma_px);
/// Sigma of a Gaussian of `fwhm_px`.
double sigma_with_pixel(double fwhm_px);
/// FWHM [px] of a Gaussian before pixels widened it to `sigma_px`; 0 if it is no wider than they.
double fwhm_before_pixel(double sigma_px);

/// PSF of a frame: one shape, whose width changes over the frame by a polynomial of second order.
/// `psf_measure.h` measures it.
struct PsfField {
  static constexpr std::size_t terms = 6;  // 1, u, v, u^2, u v, v^2
  using Polynomial = std::array<double, terms>;

  /// One Gaussian everywhere, of a FWHM before pixel integration.
  static PsfField gaussian(double fwhm_px);

  /// Gaussian nearest to the PSF at a pixel, with the pixel.
  double sigma_at(PixelPosition at) const;
  Psf at(PixelPosition at) const;
  bool is_round_gaussian() const { return count == 1 && along_x == 0.0 && along_diagonal == 0.0; }

  double width_px = 1.0;   // sigma of the nearest Gaussian, without pixel, where the scale is 1
  Polynomial log_scale{};  // logarithm of the width over u and v
  bool varies = false;     // whether log_scale is used
  double min_log_scale = 0.0, max_log_scale = 0.0;  // what stars were seen to have
  PixelPosition centre, half;                       // u = (x - centre.x) / half.x, v likewise
  // Parts of the shape: widths in units of that Gaussian's, without pixel.
  std::array<double, Psf::most> weights{1.0}, ratios{1.0};
  std::size_t count = 1;
  double along_x = 0.0, along_diagonal = 0.0;  // as of Psf, the same over the frame
  int stars = 0;                               // it was measured from; 0: it was not

  static Polynomial powers(double u, double v) { return {1, u, v, u * u, u * v, v * v}; }
  PixelPosition unit(PixelPosition at) const {
    return {(at.x_px - centre.x_px) / half.x_px, (at.y_px - centre.y_px) / half.y_px};
  }

 private:
  double scale(PixelPosition at) const;
};

}  // namespace dmise
