#pragma once
#include <optional>
#include <vector>

#include "core/astrometry/plate_match.h"
#include "core/base/image.h"
#include "core/base/parallel.h"

namespace dmise {

/// What the search for stars in a frame takes from its header.
struct StarSourceSettings {
  double gain_e_per_dn = 1.0;
  double saturation_dn = 65535.0;  // counts from here on may be clipped
  double psf_fwhm_px = 0.0;        // about; 0: not known
  double least_snr = 6.0;
  std::size_t most = 2000;  // the brightest, and of these that are not saturated
};

/// Images of stars, and of what looks like them, by falling flux [e-]: places by fits of a Gaussian
/// of the width that most of them have, or of a line of it where the image is a trail; saturated
/// ones by their moments. Equal for any number of threads.
std::vector<PlateSource> find_star_sources(const CountImage& counts,
                                           const StarSourceSettings& settings, Threads& threads);

/// How much longer than wide an image is, by its second moments: xx - yy and 2 xy [px2]. A trail of
/// (u, v) px adds a twelfth of u u - v v and 2 u v.
struct StarEllipse {
  double x_px = 0.0, y_px = 0.0;
  double plus = 0.0, cross = 0.0;
};

/// What most images of stars look like.
struct StarShape {
  double sigma_px = 0.0;              // of the Gaussian that fits best, including the pixel
  double length_px = 0.0;             // of trails that are longer than wide; 0 if there are none
  double angle_rad = 0.0;             // of the trails, against x towards y
  int stars = 0;                      // that were fitted
  std::vector<StarEllipse> ellipses;  // of each
};

/// Measures it in the brightest images that are not saturated; empty if there are less than five.
std::optional<StarShape> measure_star_shape(const CountImage& counts,
                                            const StarSourceSettings& settings, Threads& threads);

}  // namespace dmise
