#pragma once
#include <vector>

#include "core/products/pixel_mask.h"
#include "core/sequences/filtered_sequence.h"

namespace dmise {

/// Pixels that have no value in a fifth of the frames, and those that are sharper than light can be
/// in the median of the frames: 1, else 0. The median
/// shows warm pixels that no single frame does. Stars and objects that stay on the detector are as
/// wide as the PSF in it, and remain. Finds none where the PSF is as sharp as a pixel.
PixelMask find_hot_pixels(const std::vector<SequenceFrame>& frames,
                          const FilteredSequence& sequence);

}  // namespace dmise
