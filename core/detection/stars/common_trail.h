#pragma once
#include <optional>

#include "core/base/pixel.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// Measures the trail that most stars of a frame share [px, up to its sign], however they overlap:
/// most edges of light run along it, and light that begins ends so far behind. Empty if there is no
/// such trail of more than a few widths of the PSF. Does not use the scene's motion of stars.
std::optional<PixelPosition> common_trail(const Scene& scene);

}  // namespace dmise
