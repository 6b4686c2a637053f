#pragma once
#include "core/sequences/detect_sequence.h"
#include "core/sequences/track_fit.h"

namespace dmise {

/// Converts a track from pixels to directions, and from SNR to light.
SequenceTrack describe_track(const MovingTrack& track, const TrackScene& scene,
                             const std::vector<SequenceFrame>& frames);

/// Sets index and id of its detection.
void number_track(SequenceTrack& track, std::uint32_t index);

}  // namespace dmise
