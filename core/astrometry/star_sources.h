#pragma once
#include <optional>
#include <vector>

#include "core/astrometry/plate_match.h"
#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/detection/known/star_motion.h"
#include "core/detection/stars/alike_streaks.h"

namespace dmise {

/// Facts of a frame's header that the search for its stars uses, and limits of the search.
struct StarSourceSettings {
  double gain_e_per_dn = 1.0;
  double saturation_dn = 65535.0;  // counts from here on may be clipped
  double psf_fwhm_px = 0.0;        // about; 0: not known
  double min_snr = 6.0;
  std::size_t most = 2000;  // the brightest, and further ones until as many are not saturated
  const StarMotion* motion = nullptr;  // the stars' motion, if known
  bool unknown_mount = false;          // so that long trails by `motion` are searched as trails
};

/// Returns stars, and sources that look like them, by falling flux [e-]. Places are of a fitted
/// Gaussian of the stars' common width, or of a trail of it; those of saturated ones are moments.
/// If stars of an unknown mount trail far, they are the middles of the trails.
/// Equal for any number of threads.
std::vector<PlateSource> find_star_sources(const CountImage& counts,
                                           const StarSourceSettings& settings, Threads& threads);

/// Elongation of an image by its second moments: xx - yy and 2 xy [px2]. A trail of (u, v) px adds
/// a twelfth of u u - v v and of 2 u v.
struct StarEllipse {
  double x_px = 0.0, y_px = 0.0;
  double plus = 0.0, cross = 0.0;
};

/// Common shape of the images of a frame's stars.
struct StarShape {
  double sigma_px = 0.0;              // width of the Gaussian that fits best, including the pixel
  double length_px = 0.0;             // length of trails longer than wide; 0 if there are none
  double angle_rad = 0.0;             // direction of the trails, against x towards y
  int stars = 0;                      // that were fitted
  std::vector<StarEllipse> ellipses;  // one for each star
  std::vector<StreakMotion> lines;    // those longer than wide
};

/// Measures it in the brightest images that are not saturated; empty if there are fewer than five.
std::optional<StarShape> measure_star_shape(const CountImage& counts,
                                            const StarSourceSettings& settings, Threads& threads);

}  // namespace dmise
