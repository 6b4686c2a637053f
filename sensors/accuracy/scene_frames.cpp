#include "sensors/accuracy/scene_frames.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "orbit-node/load_objects.h"
#include "sensors/frame/make_sensor.h"
#include "sensors/objects/state_window_source.h"

namespace dmise {
namespace {

FrameTimes times_of(const Scenario& scenario, const std::string& sensor, std::uint32_t frame) {
  const auto& config = sensor_named(scenario, sensor);
  const auto last = frames_within(config, scenario.duration);
  if (frame < 1 || frame > last)
    throw ConfigError("--frame: must be in 1.." + std::to_string(last) + ", the exposures of " +
                      sensor + " that end within the run, got " + std::to_string(frame));
  return frame_times(config, frame);
}

/// The states around the exposure; around all before it, too, where the detector keeps charge in
/// traps.
StateWindow window_of(const Scenario& scenario, const SensorConfig& sensor, const FrameTimes& times,
                      Threads& threads) {
  const Clock clock = make_clock(scenario);
  const ObjectPopulation population = load_objects(scenario, clock);
  const StateSource states(population, clock, threads);
  const StateWindowSource windows(scenario, sensor, clock);
  return sensor.camera.detector.persistence_fraction > 0.0
             ? windows.until(times, population, states)
             : windows.around(times, population, states);
}

}  // namespace

SceneFrames::SceneFrames(const Scenario& scenario, const std::string& sensor, std::uint32_t frame,
                         Threads& threads)
    : scenario_(scenario),
      name_(sensor),
      times_(times_of(scenario_, name_, frame)),
      threads_(threads),
      window_(window_of(scenario_, this->sensor(), times_, threads)),
      stars_(load_stars(scenario_)) {}

Exposure SceneFrames::exposure() const { return exposure_of(sensor(), times_, scenario_.seed); }

std::unique_ptr<FramePipeline> SceneFrames::pipeline(const SensorConfig& as, bool planes) const {
  OutputConfig output;
  output.sources = output.background = planes;
  return std::make_unique<FramePipeline>(
      PipelineSettings{
          .sensor = as,
          .clock = make_clock(scenario_),
          .seed = scenario_.seed,
          .digest = "",
          .faintest_star_mag = scenario_.faintest_star_mag,
          .star_truth = planes,
          .output = output,
          .shapes = std::make_shared<const ObjectShapes>(scenario_.own_objects, as.camera.band,
                                                         as.effects, models_of(scenario_.objects)),
          .radiance_parts = {}},
      stars_, threads_);
}

FrameProducts SceneFrames::make(const SensorConfig& as) const {
  return pipeline(as, true)->run(times_, window_);
}

}  // namespace dmise
