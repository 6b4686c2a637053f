#pragma once
#include <cstddef>
#include <span>

#include "core/base/image.h"

namespace dmise {

/// Signal of the pixels from `first` on (row-major) when each of a pixel's four neighbours sees
/// `coupling` of its charge, and the pixel that much less. The frame's border couples with nothing
/// beyond it: charge is kept. `electrons` and `signal` must not overlap.
void interpixel_coupling(double coupling, const ElectronImage& electrons, std::size_t first,
                         std::span<float> signal);

}  // namespace dmise
