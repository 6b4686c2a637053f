#pragma once
#include <optional>
#include <vector>

#include "core/detection/scene.h"

namespace dmise {

/// Within the light of the trail: `margin_px` around the line from end to end.
bool lies_on(const Trail& trail, double x_px, double y_px, double margin_px);

/// Pixels that lie on the trail, without saturated ones.
std::vector<FitPixel> pixels_near(const Scene& scene, const Trail& trail, double margin_px);

/// A finite trail of positive flux whose middle is in the frame.
bool plausible(const Scene& scene, const Trail& trail);

/// The last fit of a source that is not a star, over all pixels near `start`, whatever component
/// they are in, with the local background free; pixels that stick out (stars beneath) are left out.
/// Nothing when the fit fails or leaves the frame. A `draft` stops before the ends have settled.
std::optional<Source> fit_source(const Scene& scene, const Trail& start, bool streak,
                                 double model_error, bool draft = false);

}  // namespace dmise
