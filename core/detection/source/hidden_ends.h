#pragma once
#include "core/detection/source/scene.h"

namespace dmise {

/// Lengths of the gaps behind a trail's ends, of pixels that a fit does not use. The first end is
/// against the trail's direction.
struct HiddenEnds {
  double first_px = 0.0, last_px = 0.0;
};

HiddenEnds hidden_ends(const Scene& scene, const Trail& trail);

/// Adds to a streak's covariance how far each end may lie in pixels that the fit did not use,
/// because stars light them or others were seen there: anywhere in such a gap.
void add_errors_of_hidden_ends(const Scene& scene, Source& source);

}  // namespace dmise
