#pragma once
#include <vector>

#include "core/photometry/band.h"

namespace dmise {

/// Cuts a band into `count` parts of equal width, from blue to red, leaving out parts without
/// response. The parts sum to the band.
std::vector<Band> parts_of(const Band& band, int count);

}  // namespace dmise
