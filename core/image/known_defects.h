#pragma once
#include <optional>

#include "core/image/fits_file.h"

namespace dmise {

/// A frame whose pixels on the camera's list of hot ones have no value, but the level around them:
/// those whose mean extra charge is more than a pixel's noise in the dark. The list is that by
/// which the camera exposes, as its dark frames show it. Empty if there are none.
std::optional<Frame> without_hot_pixels(const Frame& frame);

}  // namespace dmise
