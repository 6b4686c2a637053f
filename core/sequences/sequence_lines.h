#pragma once
#include <string>

#include "core/sequences/detect_sequence.h"

namespace dmise {

/// A track as a line of JSON: its detection, as those of frames, and the object `sequence` with its
/// rate [arcsec/s], their covariance and its positions in the frames. What depends on an unknown
/// fact is null.
std::string to_json(const SequenceTrack& track, std::uint32_t number);

}  // namespace dmise
