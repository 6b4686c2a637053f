#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/rng.h"

namespace dmise {

/// Offset of each column in one frame, a normal deviate of standard deviation `rms_e` [e-].
std::vector<float> column_offsets(double rms_e, int columns, const RngKey& key);

/// Adds them to the pixels from `first` on (row-major).
void add_columns(std::span<const float> offsets_e, std::size_t first, std::span<float> electrons);

}  // namespace dmise
