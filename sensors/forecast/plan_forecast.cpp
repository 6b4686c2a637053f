#include "sensors/forecast/plan_forecast.h"

#include "core/effects/frame_effects.h"
#include "sensors/objects/objects_in_field.h"
#include "sensors/objects/state_window_source.h"
#include "sensors/planning/exposure_planner.h"

namespace dmise {

std::vector<PlanSpan> plan_forecast(const Scenario& scenario, const SensorConfig& sensor,
                                    const ObjectPopulation& population, const Clock& clock,
                                    const StarMap* stars, Threads& threads,
                                    std::uint32_t max_frames) {
  std::vector<PlanSpan> spans;
  if (!sensor.accuracy.is_planned()) return spans;
  const bool wants_objects = sensor.effects.has(SpaceObjects::facts);
  const ObjectPopulation seen =
      wants_objects ? population
                    : only_these(population, needed_objects(sensor, population.roster));
  const StateSource source(seen, clock, threads);
  const ObjectShapes shapes(scenario.own_objects, sensor.camera.band, sensor.effects,
                            models_of(scenario.objects));
  const ExposurePlanner planner(sensor, stars, scenario.faintest_star_mag, &shapes);
  const StateWindowSource windows(scenario, sensor, clock, close_environments_s);
  for (const std::uint32_t frame : evenly(frames_within(sensor, scenario.duration), max_frames)) {
    const FrameTimes exposure = frame_times(sensor, frame);
    const StateWindow window = windows.around(exposure, seen, source);
    const View view(sensor, exposure, window, scenario.seed);
    EffectPlan plan = planner.plan(
        view, wants_objects ? objects_in_field(view, &shapes) : std::vector<std::size_t>());
    if (!spans.empty() && spans.back().plan.effects == plan.effects &&
        spans.back().shutter_closed == view.shutter_closed()) {
      spans.back().last_frame = frame;
      spans.back().end = exposure.end;
    } else {
      spans.push_back(
          {frame, frame, exposure.start, exposure.end, std::move(plan), view.shutter_closed()});
    }
  }
  return spans;
}

}  // namespace dmise
