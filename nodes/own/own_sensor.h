#pragma once
#include <string>

#include "core/config/scenario.h"
#include "core/sim/exposure_observer.h"
#include "nodes/own/own_node_run.h"

namespace dmise {

/// Observes by the program that is a sensor; empty if the sensor is a camera. `scenario` must
/// outlive it. Throws `Error` with node, frame and tick. The program's output goes into
/// logs/NODE-SENSOR.log of `directory`, the run's.
ExposureObserver own_observer(const Scenario& scenario, const std::string& sensor,
                              const std::string& directory, OwnNodeSettings settings);

}  // namespace dmise
