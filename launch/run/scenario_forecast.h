#pragma once
#include <string>
#include <vector>

#include "sensors/forecast/sensor_forecast.h"
#include "sensors/frames/load_scene.h"

namespace dmise {

/// Notes, warnings and forecasts of a scenario before it runs.
struct ScenarioForecast {
  std::size_t objects = 0;
  std::vector<SensorForecast> sensors;
  std::vector<std::string> notes, warnings;  // one line each
};

ScenarioForecast scenario_forecast(const Scenario& scenario, const ScenarioInputs& scene,
                                   const Clock& clock, const ForecastOptions& options);

/// At the start of a run: prints notes and warnings, and a line for each of the first sensors, on
/// stderr. Examines three frames of each and counts objects of small populations only.
void print_forecast(const Scenario& scenario, const ScenarioInputs& scene, const Clock& clock);

}  // namespace dmise
