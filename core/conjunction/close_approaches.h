#pragma once
#include <cstddef>
#include <vector>

#include "core/conjunction/encounter.h"
#include "core/fusion/fusion_settings.h"
#include "core/orbit/elements/elements.h"
#include "core/time/clock.h"

namespace dmise {

struct ApproachSearch {
  std::vector<std::size_t> of;  // indices of the objects whose approaches are wanted
  SimTime duration;             // from simulation time 0, > 0
  double within_m = 0.0;
  double radius_m = 0.0;        // sum of both radii
  FusionSettings beliefs = {};  // errors of element sets by their age
};

struct CloseApproach {
  std::size_t first = 0, second = 0;  // indices; `first` is one of those wanted
  Encounter encounter;                // at the closest approach
};

/// All approaches below `within_m` of some objects to all others by SGP4, by time. Each minimum of
/// a distance counts. A pair is there once.
std::vector<CloseApproach> close_approaches(const std::vector<MeanElements>& elements,
                                            const Clock& clock, const ApproachSearch& search);

}  // namespace dmise
