#include "sensors/accuracy/scene_frames.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "nodes/environment/environment_actor.h"
#include "orbit-node/orbit_actor.h"
#include "sensors/pipeline/make_sensor.h"

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

/// The world around all exposures from the first that matters for `frame` on.
World world_around(const Scenario& scenario, const SensorConfig& sensor, const FrameTimes& times,
                   Threads& threads) {
  World world(scenario.interpolation, scenario.last_tick());
  const Clock clock = make_clock(scenario);
  OrbitActor orbit(scenario, clock, threads);
  EnvironmentActor environment(scenario, clock);
  const ExposureSpan span = exposure_span(sensor, times);
  const bool traps = sensor.camera.detector.persistence_fraction > 0.0;
  constexpr Tick knots = 3;  // that the highest order of interpolation takes beyond
  const Tick last = std::min(scenario.last_tick(), span.end.ns / scenario.tick.ns + 1 + knots);
  for (Tick tick = 0; tick <= last; ++tick) {
    for (const auto& message : environment.step(tick, {})) world.add(message.state);
    for (const auto& message : orbit.step(tick, {})) world.add(message.state);
    if (!traps)
      world.forget_before(std::min(span.start, scenario.time_of(std::max<Tick>(0, tick - knots))));
  }
  return world;
}

}  // namespace

SceneFrames::SceneFrames(const Scenario& scenario, const std::string& sensor, std::uint32_t frame,
                         Threads& threads)
    : scenario_(scenario),
      name_(sensor),
      times_(times_of(scenario_, name_, frame)),
      threads_(threads),
      world_(world_around(scenario_, this->sensor(), times_, threads)),
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
  return pipeline(as, true)->run(times_, world_);
}

}  // namespace dmise
