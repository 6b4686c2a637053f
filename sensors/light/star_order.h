#pragma once
#include <cstdint>
#include <vector>

#include "core/base/column.h"
#include "core/frames/vec.h"
#include "core/optics/camera.h"

namespace dmise {

/// Drops stars that are farther than `beside_rad` beside the frame, and sorts the others by the
/// part of the field that they are in, row by row: those that are drawn one after the other share
/// pixels, which then stay in the cache. Neighbours in the catalogue stay together, as their
/// columns are read together. `direction`: of all stars of the catalogue; `camera` turns to the
/// frame.
void order_for_drawing(std::vector<std::uint32_t>& stars, const Column<Vec<Gcrs>>& direction,
                       const Rotation<CameraFrame, Gcrs>& camera, const Optics& optics,
                       double beside_rad);

}  // namespace dmise
