#pragma once
#include "core/visibility/sightings.h"

namespace dmise {

/// Reference for `find_sightings`: tests every object at every instant. No intervals.
Sightings find_sightings_one_by_one(const Sgp4Batch& batch, const SensorTrack& track,
                                    const TimeGrid& grid);

}  // namespace dmise
