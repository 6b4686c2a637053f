#pragma once
#include "core/visibility/sightings.h"

namespace dmise {

/// What `find_sightings` must equal: asks about every object at every instant. No intervals.
Sightings find_sightings_one_by_one(const Sgp4Batch& batch, const SensorTrack& track,
                                    const TimeGrid& grid);

}  // namespace dmise
