#pragma once
#include <cstddef>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/detector/pixel_flags.h"

namespace dmise {

/// Lets charge above the full well run along its column, half up and half down, into pixels with
/// room; what reaches an end of the column is drained. Returns how many pixels end full. Sets
/// `flag_full_well` and `flag_bloomed` if `flags` are given.
std::size_t blooming(double full_well_e, ElectronImage& electrons, Threads& threads,
                     FlagImage* flags = nullptr);

}  // namespace dmise
