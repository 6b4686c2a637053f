#pragma once
#include <optional>

#include "core/products/observation.h"
#include "sensors/pipeline/frame_pipeline.h"
#include "sensors/pipeline/view.h"

namespace dmise {

/// Returns what archives index of a frame. `centre`: ICRS direction of the stars in the frame's
/// centre.
Observation observation_of(const View& view, const PipelineSettings& settings,
                           const std::optional<Vec<Gcrs>>& centre);

}  // namespace dmise
