#pragma once
#include <cstdint>

#include "core/base/image.h"

namespace dmise {

/// Pixels that have no value: 1, else 0. Empty: all have one.
using PixelMask = Image<std::uint8_t, struct PixelMaskCarrier>;

}  // namespace dmise
