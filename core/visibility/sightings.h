#pragma once
#include <functional>
#include <vector>

#include "core/base/parallel.h"
#include "core/visibility/sight.h"

namespace dmise {

/// Instants `from + k step`, k = 0 .. steps.
struct TimeGrid {
  SimTime from, step;
  std::size_t steps = 0;

  SimTime at(std::size_t k) const { return {from.ns + std::int64_t(k) * step.ns}; }
  SimTime last() const { return at(steps); }
};

/// An object that is visible at one instant of the grid.
struct Sighting {
  std::uint32_t object = 0;
  std::uint32_t step = 0;
  double range_m = 0.0;
  double sunlit = 0.0;  // fraction of the Sun's disc that it sees

  bool operator==(const Sighting&) const = default;
};

/// An object that comes into sight and leaves between two instants of the grid.
struct Crossing {
  std::uint32_t object = 0;
  std::uint32_t step = 0;  // the instant before
  SimTime time;            // when it is visible
};

/// An object that the propagator has no state for at some instant looked at.
struct LostObject {
  std::uint32_t object = 0;
  Sgp4Code code = Sgp4Code::ok;
  SimTime time;  // of the first such instant
};

struct Sightings {
  std::vector<Sighting> seen;       // by object, then time
  std::vector<Crossing> crossings;  // by object, then time
  std::vector<LostObject> lost;     // by object
};

struct SightingOptions {
  bool crossings = true;
  std::function<void(double share)> progress;  // called from the calling thread, share in [0, 1]
};

/// A crossing that lasts no longer than this may be missed.
inline constexpr double shortest_crossing_s = 0.02;

/// Who is visible when: equal, to the bit, to asking `Sight` about every object at every instant,
/// for a small part of the work. States some minutes apart and a bound on each object's speed
/// (`orbit_bound`) say between which instants it can't come into sight; only the rest is looked at,
/// and cut in halves between instants, so that what crosses between them is found as well.
Sightings find_sightings(const Sgp4Batch& batch, const SensorTrack& track, const TimeGrid& grid,
                         Threads& threads, const SightingOptions& options = {});

/// The same by asking for every object at every instant: slow, for comparison. No crossings.
Sightings find_sightings_one_by_one(const Sgp4Batch& batch, const SensorTrack& track,
                                    const TimeGrid& grid);

}  // namespace dmise
