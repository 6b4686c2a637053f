#include "sensors/pipeline/cue_path.h"

#include <algorithm>
#include <cmath>

#include "core/orbit/interpolation.h"

namespace dmise {
namespace {

Vec<Gcrs> point(const std::vector<double>& xyz, std::size_t i) {
  return {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
}

}  // namespace

Motion predicted_motion(const Task& task, SimTime t) {
  const std::size_t points = task.path_m.size() / 3;
  const double steps = (t - task.path_start).seconds() / task.path_step_s;
  const double last = double(points - 2);
  const double first = std::clamp(std::floor(steps), 0.0, last);
  const auto i = std::size_t(first);
  const double u = steps - first, h = task.path_step_s;
  const Vec<Gcrs> p0 = point(task.path_m, i), p1 = point(task.path_m, i + 1);
  const Vec<Gcrs> s0 = point(task.path_m_per_s, i), s1 = point(task.path_m_per_s, i + 1);
  return {
      interpolate_cubic(u, h, p0, s0, p1, s1),
      (p1 - p0) * (6 * u * (1 - u) / h) + s0 * ((1 - u) * (1 - 3 * u)) + s1 * (u * (3 * u - 2))};
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
