#pragma once
#include <optional>

#include "core/detection/known/known_stars.h"
#include "core/detection/known/stars_seen.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// Subtracts the stars of a catalogue, and the planets, from the filtered frame and hides the
/// remains of bright ones, if the frame shows them where the header says that they are; otherwise
/// changes nothing and returns nothing. Sets `seen` to how they agree.
std::optional<KnownStars> hide_stars(const Scene& scene, FilteredFrame& frame,
                                     const CatalogueSky& sky, const FrameHeader& header,
                                     StarsSeen& seen);

}  // namespace dmise
