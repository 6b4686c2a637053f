#pragma once
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

}  // namespace dmise
