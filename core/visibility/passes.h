#pragma once
#include <optional>
#include <vector>

#include "core/visibility/sightings.h"

namespace dmise {

/// An object relative to a sensor at one instant.
struct PassMoment {
  SimTime time;
  std::optional<Horizontal> horizontal;  // without refraction; none in orbit
  double range_m = 0.0;
  double sunlit = 0.0;                      // fraction of the Sun's disc that the object sees
  double rate_rad_per_s = 0.0;              // across the camera's frame
  std::optional<double> sun_elevation_rad;  // at the site; none in orbit
};

/// A pass of an object through a sensor's sight.
struct Pass {
  std::uint32_t object = 0;
  PassMoment rise, top, set;  // top: culmination at a site, closest approach to a sensor in orbit
  bool open_start = false;    // in sight before the span
  bool open_end = false;      // in sight after the span
  bool excluded = false;      // flagged: a body is nearer to the axis than the camera allows
  double min_range_m = 0.0;
  double lit_s = 0.0;                       // sunlit time within the pass
  std::optional<SimTime> lit_from, lit_to;  // first and last sunlit instant
  double min_sun_elevation_rad = 0.0;       // minimum over the pass, at the site; 0 in orbit
};

/// Accuracy of rise, set and shadow; the top is within a tenth of a second.
inline constexpr double event_error_s = 0.01;

/// Computes the pass of each interval, with refined rise and set. In the order of the intervals.
std::vector<Pass> passes_of(const Sgp4Batch& batch, const SensorTrack& track,
                            const std::vector<VisibilityInterval>& intervals, Threads& threads);

}  // namespace dmise
