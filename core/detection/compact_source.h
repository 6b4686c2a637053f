#pragma once
#include <optional>

#include "core/detection/components.h"
#include "core/detection/detect.h"
#include "core/detection/scene.h"

namespace dmise {

/// Judges a component no longer than a few PSFs: is it what a star makes there, or blended stars,
/// or a point where stars trail, or a short streak? Nothing for stars, and for what can't be told
/// from them.
std::optional<Source> judge_compact(const Scene& scene, const Component& component,
                                    const DetectorSettings& settings);

/// The last fit of a source that is not a star, over all pixels near `start`, whatever component
/// they are in, with the local background free; pixels that stick out (stars beneath) are left out.
/// Nothing when the fit fails or leaves the frame. A `draft` stops before the ends have settled.
std::optional<Source> fit_source(const Scene& scene, const Trail& start, bool streak,
                                 double model_error, bool draft = false);

/// Is a line a better account of the light around the source than two, three or four stars in a
/// row?
bool beats_stars(const Scene& scene, const Source& source, const DetectorSettings& settings);

/// Within the light of the trail: `margin_px` around the line from end to end.
bool lies_on(const Trail& trail, double x_px, double y_px, double margin_px);

}  // namespace dmise
