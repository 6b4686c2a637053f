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

}  // namespace dmise
