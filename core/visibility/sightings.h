#pragma once
#include <functional>
#include <vector>

#include "core/base/parallel.h"
#include "core/visibility/sight.h"
#include "core/visibility/time_grid.h"
#include "core/visibility/visibility_interval.h"

namespace dmise {

/// An object that is visible at one instant of the grid.
struct Sighting {
  std::uint32_t object = 0;
  std::uint32_t step = 0;
  double range_m = 0.0;
  double sunlit = 0.0;  // fraction of the Sun's disc that it sees

  bool operator==(const Sighting&) const = default;
};

/// An object that the propagator has no state for at some instant looked at.
struct LostObject {
  std::uint32_t object = 0;
  Sgp4Code code = Sgp4Code::ok;
  SimTime time;  // of the first such instant
};

struct Sightings {
  std::vector<Sighting> seen;                 // by object, then time
  std::vector<VisibilityInterval> intervals;  // by object, then time
  std::vector<LostObject> lost;               // by object
};

struct SightingOptions {
  bool intervals = true;
  std::function<void(double share)> progress;  // called from the calling thread, share in [0, 1]
};

/// An interval that lasts no longer than this may be missed.
inline constexpr double shortest_crossing_s = 0.02;

/// Who is visible when: equal, to the bit, to asking `Sight` about every object at every instant,
/// for a small part of the work. States some minutes apart and a bound on each object's speed
/// (`orbit_bound`) say between which instants it can't come into sight; only the rest is looked at,
/// and cut in halves between instants, so that what crosses between them is found as well.
/// Intervals are looked for every 10 s where the grid is coarser, so that they do not depend on it;
/// an absence shorter than that is not noticed.
Sightings find_sightings(const Sgp4Batch& batch, const SensorTrack& track, const TimeGrid& grid,
                         Threads& threads, const SightingOptions& options = {});

}  // namespace dmise
