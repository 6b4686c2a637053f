#pragma once
#include <cstddef>

#include "core/base/pixel.h"

namespace dmise {

/// What streaks of a frame have in common.
struct AlikeStreaks {
  PixelPosition trail;    // from end to end [px], up to its sign
  std::size_t count = 0;  // streaks that are alike
};

}  // namespace dmise
