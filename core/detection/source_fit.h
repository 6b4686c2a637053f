#pragma once
#include <optional>
#include <vector>

#include "core/detection/scene.h"

namespace dmise {

/// Whether a position is within `margin_px` of the line from end to end.
bool lies_on(const Trail& trail, double x_px, double y_px, double margin_px);

/// Unsaturated pixels on the trail.
std::vector<FitPixel> pixels_near(const Scene& scene, const Trail& trail, double margin_px);

/// Whether a trail is finite, of positive flux and centred in the frame.
bool plausible(const Scene& scene, const Trail& trail);

/// Final fit of a source that is not a star, over all pixels near `start` of any component, with a
/// free local background; outlying pixels (stars underneath) are rejected. Empty if the fit fails
/// or leaves the frame. A `draft` stops before the ends have converged.
std::optional<Source> fit_source(const Scene& scene, const Trail& start, bool streak,
                                 double model_error, bool draft = false);

}  // namespace dmise
