#pragma once
#include <span>
#include <vector>

#include "core/astrometry/plate_match.h"
#include "core/astrometry/star_sources.h"
#include "core/base/parallel.h"
#include "core/image/fits_file.h"

namespace dmise {

/// Sources with the light that detection measures of them, wings included.
struct MeasuredStars {
  std::vector<PlateSource> sources;  // in their order; `saturated` where there is no such light
  bool by_psf = false;               // false: of the nearest Gaussian, as it was
};

/// Measures the frame's PSF as detection does and fits it to each source: a star and a detection
/// then have the same share of their light. `header`: with the plate, by which stars have trails.
/// Keeps the light of the Gaussian where too few stars show the PSF or it is crowded. Equal for any
/// number of threads.
MeasuredStars light_by_psf(const Frame& frame, const FrameHeader& header,
                           std::span<const PlateSource> sources, const StarSourceSettings& settings,
                           Threads& threads);

}  // namespace dmise
