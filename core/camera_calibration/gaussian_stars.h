#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/base/pixel.h"

namespace dmise {

/// A frame of stars without the marks of its detector.
struct StarPixels {
  int columns = 0, rows = 0;
  std::vector<float> light_e;  // NaN where a pixel is of no use
  std::vector<float> hot_e;    // light of hot pixels, which is taken off; may be empty
  double saturation_e = 0.0;   // light from here on may be clipped

  double at(int x, int y) const {
    return double(light_e[std::size_t(y) * std::size_t(columns) + std::size_t(x)]);
  }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < columns && y < rows; }
};

/// A place where a star is, and about how bright it is.
struct FoundStar {
  PixelPosition at;
  double flux_e = 0.0;
  bool saturated = false;
};

/// The Gaussian that fits a star best, by least squares of even weight within two widths about it
/// and with a level of its own. Variances are before the pixel's.
struct GaussianStar {
  std::size_t frame = 0, star = 0;  // in the list of places
  PixelPosition at;
  double flux_e = 0.0, flux_sigma_e = 0.0;
  double xx_px2 = 0.0, xy_px2 = 0.0, yy_px2 = 0.0;
  double variance_sigma_px2 = 0.0;  // error of their mean, by noise of the sky and star's photons

  double mean_px2() const { return 0.5 * (xx_px2 + yy_px2); }
};

/// Radius of the window of the fits, by the width of most stars.
inline double window_radius_px(double fwhm_px) { return 2 * fwhm_px + 1; }

/// Fits the stars that are bright and not blended. `fwhm_px`: about the width of most; it sets the
/// window of the fits.
std::vector<GaussianStar> measure_star_images(const StarPixels& pixels,
                                              std::span<const FoundStar> places, double fwhm_px);

/// Light of a star.
struct StarAperture {
  double flux_e = 0.0, sigma_e = 0.0;
};

/// Radius of the aperture, in widths.
inline constexpr double aperture_widths = 5.0;

/// Light within an aperture about a star less the sky about it, which is taken beside `others`;
/// empty where a stranger, which is no star of the catalogue, or the frame's edge is near.
/// `illumination` is what the lens lets pass at a pixel, relative: it falls ever faster to the
/// corners, so that the sky of a ring is darker than that of its middle.
std::optional<StarAperture> aperture_light(
    const StarPixels& pixels, const FoundStar& star, std::span<const FoundStar> strangers,
    std::span<const PixelPosition> others, double fwhm_px,
    const std::function<double(PixelPosition)>& illumination);

}  // namespace dmise
