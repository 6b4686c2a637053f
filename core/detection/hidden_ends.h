#pragma once
#include "core/detection/scene.h"

namespace dmise {

/// Adds to a streak's covariance how far each end may lie in pixels that the fit did not use,
/// because stars light them: anywhere in such a gap.
void add_errors_of_hidden_ends(const Scene& scene, Source& source);

}  // namespace dmise
