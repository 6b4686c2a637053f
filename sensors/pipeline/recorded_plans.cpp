#include "sensors/pipeline/recorded_plans.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/base/text_file.h"
#include "core/config/effect_list.h"
#include "sensors/pipeline/cost_lines.h"
#include "sensors/pipeline/frame_times.h"

namespace dmise {
namespace {

using Json = nlohmann::json;

RecordedPlans plans_of(const Json& frames, const std::string& sensor) {
  RecordedPlans plans;
  for (const auto& frame : frames) {
    if (frame.value("sensor", "") != sensor || !frame.contains("plan")) continue;
    auto& levels = plans[frame.at("frame").get<std::uint32_t>()];
    for (const auto& [effect, planned] : frame.at("plan").at("effects").items())
      levels[effect] = planned.at("level").get<std::string>();
  }
  return plans;
}

/// Frames whose plan is that of the line before have none of their own beyond the first thousand.
void fill_gaps(RecordedPlans& plans, std::uint32_t frames) {
  for (std::uint32_t frame = frames_with_own_cost + 1; frame <= frames; ++frame)
    if (const auto before = plans.find(frame - 1); before != plans.end())
      plans.try_emplace(frame, before->second);
}

}  // namespace

void replay_plans(const std::string& run_json, Scenario& scenario) {
  const Json run = Json::parse(read_text_file(run_json), nullptr, false);
  try {
    if (!run.is_object() || !run.at("frames").is_array()) throw ConfigError("it has no frames");
    for (auto& sensor : scenario.sensors) {
      if (!sensor.is_camera()) continue;
      sensor.recorded_plans = plans_of(run.at("frames"), sensor.name);
      if (sensor.recorded_plans.empty())
        throw ConfigError("no planned frames of sensor " + sensor.name);
      fill_gaps(sensor.recorded_plans, frames_within(sensor, scenario.duration));
      SceneFacts scene = scene_facts(sensor);
      scene.stars = !scenario.star_catalogue_path.empty();
      scene.shapes = have_shapes(scenario.objects, scenario.own_objects);
      const auto effects = plannable_effects(sensor, scene);
      for (std::uint32_t frame = 1; frame <= frames_within(sensor, scenario.duration); ++frame)
        recorded_effects(effects, sensor, frame);
    }
  } catch (const Json::exception&) {
    throw ConfigError(printable(run_json) + ": not the run.json of a planned run");
  } catch (const ConfigError& error) {
    throw ConfigError(printable(run_json) + ": " + error.what());
  }
}

}  // namespace dmise
