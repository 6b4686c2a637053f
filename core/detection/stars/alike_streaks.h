#pragma once
#include <optional>
#include <span>

#include "core/detection/source/scene.h"
#include "core/detection/stars/alike_trail.h"

namespace dmise {

/// The most streaks that agree in length, direction and bend to their errors, if they are more than
/// chance makes of so many. Empty if they lie in a row, as satellites of a train do, or are fewer
/// than three.
std::optional<AlikeStreaks> alike_streaks(std::span<const Source> sources);

}  // namespace dmise
