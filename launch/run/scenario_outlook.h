#pragma once
#include <string>
#include <vector>

#include "sensors/frames/load_scene.h"
#include "sensors/outlook/sensor_outlook.h"

namespace dmise {

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
