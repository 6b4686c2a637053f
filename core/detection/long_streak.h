#pragma once
#include <vector>

#include "core/detection/components.h"
#include "core/detection/detect.h"
#include "core/detection/scene.h"

namespace dmise {

/// Straight (or slightly bent) lines of light in a component much longer than a star: satellites'
/// streaks with whatever stars touch them, crossing streaks apart. Each is followed along its
/// direction beyond the component, over gaps, as far as its brightness goes on. Chains of blended
/// stars, which are neither even nor narrow, give nothing. Appends to `found`; what lies on a
/// streak found before is taken for a piece of it.
void find_long_streaks(const Scene& scene, const Component& component,
                       const DetectorSettings& settings, std::vector<Source>& found);

}  // namespace dmise
