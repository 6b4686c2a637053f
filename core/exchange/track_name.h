#pragma once
#include <string>

#include "core/products/track.h"

namespace dmise {

/// "TRACK 3", by which messages name a track.
inline std::string track_name(const Track& track) { return "TRACK " + std::to_string(track.id); }

}  // namespace dmise
