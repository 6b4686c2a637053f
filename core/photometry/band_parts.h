#pragma once
#include <vector>

#include "core/photometry/band.h"

namespace dmise {

/// A band cut into `count` parts of equal width, from blue to red; parts that no light passes are
/// left out. What passes them sums to what passes the band.
std::vector<Band> parts_of(const Band& band, int count);

}  // namespace dmise
