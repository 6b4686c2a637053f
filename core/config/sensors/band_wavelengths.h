#pragma once
#include <vector>

#include "core/optics/pupil_sampling.h"
#include "core/photometry/band.h"

namespace dmise {

/// Centres of `count` equal parts of a band, with the parts' fractions of its response.
std::vector<WavelengthShare> wavelengths_of(const Band& band, int count);

}  // namespace dmise
