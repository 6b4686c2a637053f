#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/config/scenario.h"
#include "core/plan/planner.h"
#include "core/propagation/object_states.h"
#include "core/sky/stars/star_map.h"

namespace dmise {

/// Frames of a sensor that have one plan, and the plan of the first of them.
struct PlanSpan {
  std::uint32_t first_frame = 1, last_frame = 1;
  SimTime start, end;  // start of the first exposure, end of the last
  EffectPlan plan;
  bool shutter_closed = false;
};

/// Plans the frames of a sensor as its run does, at most `max_frames` of them, evenly over the
/// run. Empty for a sensor that is not planned. `stars` may be null.
std::vector<PlanSpan> plan_forecast(const Scenario& scenario, const SensorConfig& sensor,
                                    const ObjectPopulation& population, const Clock& clock,
                                    const StarMap* stars, Threads& threads,
                                    std::uint32_t max_frames);

}  // namespace dmise
