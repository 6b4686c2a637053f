#pragma once
#include "core/products/task.h"
#include "sensors/scene/state_window.h"

namespace dmise {

/// Where a task's target is predicted to be: cubic between the points of its path, and by the first
/// or last of them beyond.
Motion predicted_motion(const Task& task, SimTime t);

/// The task that governs an exposure, of those that a sensor was given, in the order of their ids:
/// it is on its target all the time from `start` to `end`, and no later one begins before `end`.
/// Null: there is none; the mount slews or stands still.
const Task* task_during(const std::vector<std::shared_ptr<const Task>>& tasks, SimTime start,
                        SimTime end);

}  // namespace dmise
