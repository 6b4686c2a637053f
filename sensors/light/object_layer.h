#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/products/truth.h"
#include "sensors/objects/object_shapes.h"
#include "sensors/scene/occlusion_mask.h"
#include "sensors/scene/optics_stage.h"
#include "sensors/scene/view.h"

namespace dmise {

// Space objects as streaks: those that the field, the horizon, the Earth and its shadow leave, each
// along its own path with its own brightness over the exposure.

/// Adds their light to `image` and returns what was drawn. An object of which no light fell inside
/// and whose path did not enter the frame has no entry. `mask`, empty at first, collects what
/// objects with a shape hide; nearer ones hide farther ones.
std::vector<Truth> draw_objects(const View& view, const std::vector<std::size_t>& objects,
                                const ObjectShapes* shapes, OpticsStage& optics,
                                OcclusionMask& mask, ExpectedElectronImage& image);

}  // namespace dmise
