#pragma once
#include <vector>

#include "sensors/pipeline/object_shapes.h"
#include "sensors/pipeline/view.h"

namespace dmise {

/// Objects whose path over the exposure may touch the frame, also between its ends: distances from
/// the cone around the field and bounds on the speed, as `dmise visible` finds crossings. The
/// sensor's own platform is left out. With `shapes` an object counts as far as its shape reaches.
std::vector<std::size_t> objects_in_field(const View& view, const ObjectShapes* shapes = nullptr);

}  // namespace dmise
