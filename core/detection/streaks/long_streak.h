#pragma once
#include <vector>

#include "core/detection/pixels/components.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// Finds straight (or slightly curved) streaks in a component much longer than a star, separated
/// from stars they touch and from crossing streaks. Each is followed beyond the component, across
/// gaps, as far as its brightness continues. Chains of blended stars, which are neither even nor
/// narrow, are rejected. Appends to `found`; light on a known streak is part of it.
void find_long_streaks(const Scene& scene, const Component& component, std::vector<Source>& found);

}  // namespace dmise
