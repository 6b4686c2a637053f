#pragma once
#include <optional>
#include <vector>

#include "core/image/chart.h"
#include "core/orbit/elements.h"
#include "core/visibility/sightings.h"

namespace dmise {

struct RangeFigureOptions {
  bool dark = false;                      // the objects in the Earth's shadow, not the sunlit ones
  std::optional<double> night_below_rad;  // only while the Sun is lower than this at the site
};

/// Range against time of all objects in a sensor's field and sunlit: Figure 5 of the DMISE-GHOST
/// paper. A line for each stay, coloured by the kind of orbit; on the ground the night is shaded.
Chart range_figure(const SensorTrack& track, const TimeGrid& grid,
                   const std::vector<MeanElements>& elements, const Sightings& sightings,
                   const RangeFigureOptions& options);

/// Elevation of the Sun over a site at every instant of the grid; empty in orbit.
std::vector<double> sun_elevations_rad(const SensorTrack& track, const TimeGrid& grid);

}  // namespace dmise
