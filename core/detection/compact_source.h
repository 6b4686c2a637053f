#pragma once
#include <optional>

#include "core/detection/components.h"
#include "core/detection/detect.h"
#include "core/detection/scene.h"

namespace dmise {

/// Classifies a component no longer than a few PSFs: a star of this frame, blended stars, a point
/// among trailed stars, or a short streak. Empty for stars and for sources that cannot be
/// distinguished from them.
std::optional<Source> judge_compact(const Scene& scene, const Component& component,
                                    const DetectorSettings& settings);

}  // namespace dmise
