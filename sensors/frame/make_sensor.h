#pragma once
#include <memory>
#include <string>

#include "sensors/frame/sensor_evaluator.h"

namespace dmise {

/// The scenario's star catalogue, indexed; null when it names none. Kept in the user's cache
/// directory ($XDG_CACHE_HOME/dmise or ~/.cache/dmise) for the next process.
std::shared_ptr<const StarMap> load_stars(const Scenario& scenario);

/// The scenario's own objects if its sensors propagate states; null if they take published ones.
std::shared_ptr<const std::vector<OwnObject>> propagated_by_sensors(const Scenario& scenario);

/// What all frames of the sensor `name` share. `digest` goes into its frames.
PipelineSettings sensor_settings(const Scenario& scenario, const std::string& name,
                                 const std::string& digest);
RunGrid run_grid(const Scenario& scenario);

/// The sensor `name` of the scenario. `digest` goes into its frames; `directory` is the run's, the
/// sensor writes into its own below it; empty: it writes nothing. `finder` is the sensor's
/// detector, `observer` the sensor, if that is a program of the user's.
std::unique_ptr<SensorEvaluator> make_sensor(const Scenario& scenario, const std::string& name,
                                             const std::string& digest,
                                             const std::string& directory,
                                             std::shared_ptr<const StarMap> stars, Threads& threads,
                                             SourceFinder finder = {},
                                             ExposureObserver observer = {});

}  // namespace dmise
