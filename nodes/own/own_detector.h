#pragma once
#include <string>

#include "core/config/scenario.h"
#include "core/detection/described_sources.h"
#include "nodes/own/own_node_run.h"

namespace dmise {

/// Finds sources by the program that detects in the frames of a sensor; empty if that is our own.
/// `scenario` must outlive it. Throws `Error` with node, frame and tick. The program's output goes
/// into logs/NODE-SENSOR.log of `directory`, the run's.
SourceFinder own_finder(const Scenario& scenario, const std::string& sensor,
                        const std::string& directory, OwnNodeSettings settings);

}  // namespace dmise
