#pragma once
#include <vector>

#include "core/config/sensors/sensor_settings.h"
#include "core/orbit/interpolation.h"

namespace dmise {

/// Chooses the order for a run that states none: the lowest whose worst error between ticks of
/// `tick_s` is below about a metre and displaces an object by no more than a quarter of the
/// position budget of any planned sensor, seen from 200 km (on the ground) or 10 km (in orbit).
/// Where no order does, the one with the least error among those below a metre; the cubic where
/// there is none.
HermiteOrder choose_interpolation(const std::vector<SensorConfig>& sensors, double tick_s);

}  // namespace dmise
