#pragma once
#include <cstddef>
#include <optional>
#include <span>

#include "core/base/pixel.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// What streaks of a frame have in common.
struct AlikeStreaks {
  PixelPosition trail;    // from end to end [px], up to its sign
  std::size_t count = 0;  // streaks that are alike
};

/// The most streaks that agree in length, direction and bend to their errors, if they are more than
/// chance makes of so many. Empty if they lie in a row, as satellites of a train do, or are fewer
/// than three.
std::optional<AlikeStreaks> alike_streaks(std::span<const Source> sources);

}  // namespace dmise
