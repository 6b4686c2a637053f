#pragma once
#include <memory>
#include <string>
#include <vector>

#include "sensors/outlook/sensor_outlook.h"

namespace dmise {

/// Inputs that a run reads before its first frame. All errors in them are reported before the run's
/// directory is touched.
struct ScenarioInputs {
  ObjectPopulation population;
  std::shared_ptr<const StarMap> stars;  // null: none
};

/// Throws `ConfigError` with the position of the invalid key.
ScenarioInputs load_scene(const Scenario& scenario, const Clock& clock);

/// Notes, warnings and outlooks of a scenario before it runs.
struct ScenarioOutlook {
  std::size_t objects = 0;
  std::vector<SensorOutlook> sensors;
  std::vector<std::string> notes, warnings;  // one line each
};

ScenarioOutlook scenario_outlook(const Scenario& scenario, const ScenarioInputs& scene,
                                 const Clock& clock, const OutlookOptions& options);

/// At the start of a run: prints notes and warnings, and a line for each of the first sensors, on
/// stderr. Examines three frames of each and counts objects of small populations only.
void print_outlook(const Scenario& scenario, const ScenarioInputs& scene, const Clock& clock);

}  // namespace dmise
