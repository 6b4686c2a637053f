#pragma once
#include <functional>
#include <vector>

#include "core/base/parallel.h"
#include "core/visibility/sight.h"
#include "core/visibility/time_grid.h"

namespace dmise {

/// An object that is visible at one instant of the grid.
struct Sighting {
  std::uint32_t object = 0;
  std::uint32_t step = 0;
  double range_m = 0.0;
  double sunlit = 0.0;  // fraction of the Sun's disc visible from it

  bool operator==(const Sighting&) const = default;
};

/// An object without a state at some examined instant.
struct LostObject {
  std::uint32_t object = 0;
  Sgp4Code code = Sgp4Code::ok;
  SimTime time;  // first such instant
};

/// An object is visible from `in_first` to `in_last` and invisible at `out_before` and `out_after`,
/// except at ends of the span. It may be as short as a crossing between two examined instants.
struct VisibilityInterval {
  std::uint32_t object = 0;
  SimTime out_before, in_first, in_last, out_after;
  bool open_start = false;  // visible at the span's beginning
  bool open_end = false;    // and at its end

  bool operator==(const VisibilityInterval&) const = default;
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

/// Shorter intervals may be missed.
inline constexpr double shortest_crossing_s = 0.02;

/// Finds which objects are visible when: equal to the bit to evaluating `Sight` for every object at
/// every instant, at a small part of the cost. States some minutes apart and a bound on each
/// object's speed (`orbit_bound`) exclude most instants; the rest is evaluated, and bisected to
/// find crossings between instants. Intervals are searched at steps of at most 10 s, independent of
/// the grid; a gap shorter than that is not noticed.
Sightings find_sightings(const Sgp4Batch& batch, const SensorTrack& track, const TimeGrid& grid,
                         Threads& threads, const SightingOptions& options = {});

}  // namespace dmise
