#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/detection/known/known_stars.h"
#include "core/detection/known/star_motion.h"
#include "core/detection/light/psf.h"
#include "core/detection/light/trail_fit.h"
#include "core/detection/pixels/background.h"
#include "core/detection/pixels/filtered_frame.h"
#include "core/products/pixel_mask.h"

namespace dmise {

/// A frame prepared for fits: background-subtracted electrons, noise, saturation, star trails.
struct Scene {
  const CountImage& counts;
  const Background& background;
  const StarMotion& stars;
  double gain_e_per_dn;
  double saturation_dn;                   // lowest possibly clipped count, with read noise
  double sigma_px;                        // width of a point source, including the pixel
  bool blooming;                          // charge above the full well flows along columns
  PsfField psf;                           // with it: sigma_px is the width in the frame's middle
  const PixelMask* unusable = nullptr;    // pixels without a value; null: all have one
  const FilteredFrame* hidden = nullptr;  // whose hidden pixels are not used; null: none are
  const KnownStars* known = nullptr;      // whose pixels are not used; null: none are known
  // Tells the scatter of the sky; null: it is noise alone.
  const FilteredFrame* flat = nullptr;
  double sources_per_px2 = 0.0;  // above the threshold of a component; 0: not known

  /// Takes a PSF that was measured.
  void use(const PsfField& measured) {
    psf = measured;
    sigma_px = psf.sigma_at({(counts.columns - 1) / 2.0, (counts.rows - 1) / 2.0});
  }
  bool contains(int x, int y) const {
    return x >= 0 && y >= 0 && x < counts.columns && y < counts.rows;
  }
  double diagonal_px() const { return std::hypot(counts.columns, counts.rows); }
  bool is_hidden(int x, int y) const {
    return (hidden && hidden->row(y)[x] == 0) || (known && known->lights(x, y));
  }
  /// Whether a star of this light at a place would be known.
  bool would_be_known(double x_px, double y_px, double flux_e) const {
    return known && known->would_know({x_px, y_px}, flux_e);
  }
  /// Whether that holds of each star in a row that has the light of a trail; a row as long as 45 px
  /// may be of four.
  bool row_would_be_known(const Trail& t) const {
    return would_be_known(t.x_px, t.y_px,
                          t.flux_e / std::fmin(std::fmax(1 + t.length_px / 15, 2.0), 4.0));
  }
  bool has_value(int x, int y) const { return !unusable || unusable->at(x, y) == 0; }
  bool saturated(int x, int y) const { return counts.at(x, y) >= saturation_dn; }
  /// Whether a pixel has a value and is neither hidden nor clipped nor next to a clipped pixel's
  /// overflow.
  bool is_usable(int x, int y) const {
    if (!has_value(x, y) || saturated(x, y) || is_hidden(x, y)) return false;
    return !blooming ||
           !((y > 0 && saturated(x, y - 1)) || (y + 1 < counts.rows && saturated(x, y + 1)));
  }
  FitPixel pixel(int x, int y) const {
    return pixel(x, y, background.level_dn(x, y), background.sigma_dn(x, y));
  }
  /// A pixel where level and noise of the sky are known.
  FitPixel pixel(int x, int y, float level_dn, float sigma_dn) const {
    const double noise_e = sigma_dn * gain_e_per_dn;
    return {x, y, float((counts.at(x, y) - level_dn) * gain_e_per_dn), float(noise_e * noise_e)};
  }
  /// The pixel around a place, or the nearest to it in the frame.
  FitPixel pixel_around(double x_px, double y_px) const {
    return pixel(std::clamp(int(x_px), 0, counts.columns - 1),
                 std::clamp(int(y_px), 0, counts.rows - 1));
  }
  /// Noise of a pixel without sources at a place, or at the nearest in the frame.
  double noise_e_at(double x_px, double y_px) const {
    const int x = std::clamp(int(std::lround(x_px)), 0, counts.columns - 1);
    const int y = std::clamp(int(std::lround(y_px)), 0, counts.rows - 1);
    return background.sigma_dn(x, y) * gain_e_per_dn;
  }
  /// Trail of a star at a position, without flux.
  Trail star_trail(double x_px, double y_px) const {
    const PixelPosition d = stars.trail_at({x_px, y_px});
    return {.x_px = x_px,
            .y_px = y_px,
            .length_px = std::hypot(d.x_px, d.y_px),
            .angle_rad = std::atan2(d.y_px, d.x_px)};
  }
};

/// A source after its final fit.
struct Source {
  TrailFit fit;       // trails[0]; line parameters free if `streak`
  unsigned free = 0;  // mask of the free ones
  bool streak = false;
  bool saturated = false;
  bool at_edge = false;
  bool beside = false;          // fitted together with another one beside it
  double model_error = 0.0;     // relative error of the PSF in comparisons
  int flashes = 0;              // joined ones of a body that blinks; 0: it is one light
  double broad_sigma_px = 0.0;  // width of a streak that is wider than the PSF; 0: it is not

  const Trail& trail() const { return fit.trails[0]; }
  double snr() const { return trail().flux_e / std::sqrt(fit.cov(2, 2)); }
};

}  // namespace dmise
