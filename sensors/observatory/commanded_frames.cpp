#include "sensors/observatory/commanded_frames.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "core/detector/persistence.h"
#include "sensors/observatory/filter_wheel.h"

namespace dmise {

std::vector<SensorConfig> commanded_sensors(const Scenario& scenario) {
  std::vector<SensorConfig> sensors;
  for (const SensorConfig& sensor : scenario.sensors)
    if (sensor.is_camera() && site_of(sensor)) sensors.push_back(sensor);
  return sensors;
}

void check_observatory(const Scenario& scenario) {
  if (!scenario.own_nodes.empty())
    throw ConfigError(scenario.own_nodes.front().where +
                      ": an observatory starts no programs and waits for none");
  const auto sensors = commanded_sensors(scenario);
  if (sensors.empty())
    throw ConfigError(scenario.path + ": sensors: an observatory needs a camera at a site");
  for (const SensorConfig& sensor : sensors)
    if (sensor.effects.has(Persistence::facts) && sensor.camera.detector.persistence_fraction > 0.0)
      throw ConfigError(sensor.where +
                        ".effects: must have persistence: off in an observatory, whose exposures "
                        "are at no known times");
}

CommandedFrames::CommandedFrames(const Scenario& scenario, const ScenarioInputs& scene,
                                 const std::string& sensor, const std::string& digest,
                                 const std::string& directory, int threads)
    : threads_(threads),
      scenario_(scenario),
      sensor_(sensor),
      digest_(digest),
      clock_(make_clock(scenario)),
      stars_(scene.stars),
      population_(scene.population),
      windows_(scenario, sensor_named(scenario, sensor), clock_),
      states_(scene.population, clock_, threads_),
      writer_(directory + "/" + sensor, scenario.output, clock_) {
  settings_of(0);
}

const PipelineSettings& CommandedFrames::settings_of(int filter) {
  const auto known = settings_.find(filter);
  if (known != settings_.end()) return known->second;
  Scenario filtered = scenario_;
  for (SensorConfig& sensor : filtered.sensors)
    if (sensor.name == sensor_) set_filter(sensor.camera, filter);
  return settings_.emplace(filter, sensor_settings(filtered, sensor_, digest_)).first->second;
}

FrameProducts CommandedFrames::make(const CommandedExposure& exposure) {
  PipelineSettings settings = settings_of(exposure.filter);
  settings.sensor = commanded_sensor(settings.sensor, exposure);
  const FrameTimes times = exposure.times();
  const StateWindow window = windows_.around(times, population_, states_);
  return FramePipeline(std::move(settings), stars_, threads_).run(times, window);
}

}  // namespace dmise
