#include "sensors/frame/recorded_plans.h"

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/config/sensors/effect_list.h"
#include "core/run/run_record.h"
#include "sensors/frame/cost_lines.h"
#include "sensors/scene/frame_times.h"

namespace dmise {
namespace {

/// Frames whose plan is that of the line before have none of their own beyond the first thousand.
void fill_gaps(RecordedPlans& plans, std::uint32_t frames) {
  for (std::uint32_t frame = frames_with_own_cost + 1; frame <= frames; ++frame)
    if (const auto before = plans.find(frame - 1); before != plans.end())
      plans.try_emplace(frame, before->second);
}

}  // namespace

void replay_plans(const std::string& run_json, Scenario& scenario) {
  auto levels = read_planned_levels(run_json);
  try {
    for (auto& sensor : scenario.sensors) {
      if (!sensor.is_camera()) continue;
      sensor.recorded_plans = std::move(levels[sensor.name]);
      if (sensor.recorded_plans.empty())
        throw ConfigError("no planned frames of sensor " + sensor.name);
      fill_gaps(sensor.recorded_plans, frames_within(sensor, scenario.duration));
      SceneFacts scene = scene_facts(sensor);
      scene.stars = !scenario.star_catalogue_path.empty();
      scene.shapes = have_shapes(scenario.objects, scenario.own_objects);
      scene.glints = have_glints(scenario.objects, scenario.own_objects);
      const auto effects = plannable_effects(sensor, scene);
      for (std::uint32_t frame = 1; frame <= frames_within(sensor, scenario.duration); ++frame)
        recorded_effects(effects, sensor, frame);
    }
  } catch (const ConfigError& error) {
    throw ConfigError(printable(run_json) + ": " + error.what());
  }
}

}  // namespace dmise
