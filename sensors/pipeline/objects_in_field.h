#pragma once
#include <vector>

#include "sensors/pipeline/view.h"

namespace dmise {

/// Objects whose path over the exposure may touch the frame, also between its ends: distances from
/// the cone around the field and bounds on the speed, as `dmise visible` finds crossings. The
/// sensor's own platform is left out.
std::vector<std::size_t> objects_in_field(const View& view);

}  // namespace dmise
