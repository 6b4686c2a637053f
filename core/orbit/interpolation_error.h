#pragma once
#include <optional>
#include <string>

#include "core/orbit/interpolation.h"

namespace dmise {

/// Interpolation error of the objects of a catalogue [m]: the greatest distance from SGP4 of each
/// object, of these the median and the maximum.
struct StatedInterpolationError {
  double median_m = 0.0, worst_m = 0.0;
};

/// Measured by `dmise bench interpolation` on the 18,470 element sets of 2019-12-19, at this tick
/// or the next longer one measured (5, 10, 20, 30, 60, 120, 180, 240, 300 s); empty beyond. In the
/// first and last tick of a run order 7 is up to 3.2 times worse, because its ticks lie on one
/// side.
std::optional<StatedInterpolationError> stated_interpolation_error(HermiteOrder order,
                                                                   double tick_s);

/// As text: "order 3, ticks of 5 s: 1.3e-05 m median, 5.9e-05 m at worst".
std::string interpolation_text(HermiteOrder order, double tick_s);

/// Longest tick [s] that a scenario with objects may have: the longest measured one with a maximum
/// error of about a metre.
double longest_tick_s(HermiteOrder order);

}  // namespace dmise
