#pragma once
#include <optional>
#include <vector>

#include "core/image/charts/chart.h"
#include "core/orbit/elements/elements.h"
#include "core/visibility/sightings.h"

namespace dmise {

struct RangeFigureOptions {
  bool dark = false;                      // objects in the Earth's shadow instead of sunlit ones
  std::optional<double> night_below_rad;  // only while the Sun is below this elevation at the site
};

/// Range against time of all sunlit objects in a sensor's field: Figure 5 of the DMISE-GHOST paper.
/// One line per pass, coloured by orbit class; night is shaded on the ground.
Chart range_figure(const SensorTrack& track, const TimeGrid& grid,
                   const std::vector<MeanElements>& elements, const Sightings& sightings,
                   const RangeFigureOptions& options);

/// Elevation of the Sun at a site at every instant of the grid; empty in orbit.
std::vector<double> sun_elevations_rad(const SensorTrack& track, const TimeGrid& grid);

}  // namespace dmise
