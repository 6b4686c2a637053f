#include "sensors/scene/cue_path.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

Motion point(const Task& task, std::size_t i) {
  const auto at = [i](const std::vector<double>& xyz) {
    return Vec<Gcrs>{xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
  };
  return {at(task.path_m), at(task.path_m_per_s)};
}

}  // namespace

Motion predicted_motion(const Task& task, SimTime t) {
  const std::size_t points = task.path_m.size() / 3;
  const double steps = (t - task.path_start).seconds() / task.path_step_s;
  const double first = std::clamp(std::floor(steps), 0.0, double(points - 2));
  const auto i = std::size_t(first);
  return cubic_motion(steps - first, task.path_step_s, point(task, i), point(task, i + 1));
}

const Task* task_during(const std::vector<std::shared_ptr<const Task>>& tasks, SimTime start,
                        SimTime end) {
  for (auto task = tasks.rbegin(); task != tasks.rend(); ++task) {
    if ((*task)->start >= end) continue;
    return (*task)->on_target <= start && (*task)->end >= end ? task->get() : nullptr;
  }
  return nullptr;
}

}  // namespace dmise
