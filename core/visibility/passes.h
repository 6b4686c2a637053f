#pragma once
#include <optional>
#include <vector>

#include "core/visibility/sightings.h"

namespace dmise {

/// An object as a sensor has it at one instant.
struct PassMoment {
  SimTime time;
  std::optional<Horizontal> horizontal;  // without refraction; none in orbit
  double range_m = 0.0;
  double sunlit = 0.0;                      // fraction of the Sun's disc that the object sees
  double rate_rad_per_s = 0.0;              // across the camera's frame
  std::optional<double> sun_elevation_rad;  // at the site; none in orbit
};

/// An object's passage through a sensor's sight.
struct Pass {
  std::uint32_t object = 0;
  PassMoment rise, top, set;  // top: highest over a site, nearest to a sensor in orbit
  bool open_start = false;    // was in sight before the span began
  bool open_end = false;      // still is when it ends
  double least_range_m = 0.0;
  double lit_s = 0.0;                       // how long it is sunlit within the pass
  std::optional<SimTime> lit_from, lit_to;  // first and last sunlit instant, when there is one
  double least_sun_elevation_rad = 0.0;     // over the pass, at the site; 0 in orbit
};

/// Rise, set and shadow are found to this, the top within a tenth of a second.
inline constexpr double event_error_s = 0.01;

/// The pass of each interval: rise and set refined, the rest looked up along the way. In the order
/// of the intervals.
std::vector<Pass> passes_of(const Sgp4Batch& batch, const SensorTrack& track,
                            const std::vector<VisibilityInterval>& intervals, Threads& threads);

}  // namespace dmise
