#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/astrometry/plate_frame.h"
#include "core/astrometry/plate_match.h"
#include "core/astrometry/star_sources.h"
#include "core/astrometry/zero_point.h"
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

/// Zero point of a frame from the catalogue's stars that its plate shows. Stars take part by the
/// light that the catalogue leads to expect, never by the light measured, which would select those
/// that noise brightens; variable stars, and stars on which others shine, are left out, the light
/// that a lens with a table loses is added. Empty without an exposure or a star.
std::optional<ZeroPoint> zero_point_of(const Frame& frame, const PlateSolution& plate,
                                       const MeasuredStars& light, const PlateSky& sky);

}  // namespace dmise
