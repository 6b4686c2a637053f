#include "core/fusion/scheduler.h"

#include <algorithm>

namespace dmise {
namespace {

constexpr std::size_t max_plans = 24;  // for a sensor at once: the best by `rough_rate`
constexpr int heard_after_ticks = 2;
constexpr double path_margin_s = 10.0;  // before and after exposures, for clocks that are wrong

}  // namespace

Scheduler::Scheduler(const Clock& clock, SimTime reference, std::vector<CuedSensor> sensors,
                     SimTime last, double best_detection_probability)
    : clock_(clock),
      forces_(clock, reference),
      last_(last),
      best_detection_probability_(best_detection_probability) {
  std::ranges::sort(sensors, {}, &CuedSensor::name);
  for (CuedSensor& sensor : sensors) {
    const MountPosition park = mount_position(sensor.park_azimuth_deg, sensor.park_elevation_deg);
    mounts_.push_back({std::move(sensor), park, {}});
  }
}

bool Scheduler::is_asked(SimTime begin, SimTime next) const {
  return begin < last_ &&
         std::ranges::any_of(mounts_, [&](const Mount& m) { return m.free < next; });
}

std::vector<Scheduler::Option> Scheduler::options(const CueSky& sky, const Mount& mount,
                                                  SimTime start,
                                                  std::span<const CueTarget> targets) const {
  std::vector<std::pair<double, const CueTarget*>> rough;
  for (const CueTarget& target : targets)
    if (const double rate = rough_rate(sky, mount.sensor, target, mount.position, start); rate > 0)
      rough.push_back({rate, &target});
  std::ranges::sort(rough, [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second->track < b.second->track;
  });
  if (rough.size() > max_plans) rough.resize(max_plans);
  std::vector<Option> out;
  for (const auto& [rate, target] : rough)
    if (auto plan = plan_observation(forces_, sky, mount.sensor, *target, mount.position, start,
                                     last_, best_detection_probability_))
      out.push_back({target, std::move(*plan), 0.0});
  return out;
}

std::vector<Scheduler::Option> Scheduler::wished(const CueSky& sky, const Mount& mount,
                                                 SimTime start, std::span<const CueTarget> targets,
                                                 CueWish& wish) const {
  CuedSensor sensor = mount.sensor;
  if (wish.exposures > 0) sensor.cue.exposures = int(wish.exposures);
  const auto target = std::ranges::find(targets, wish.track, &CueTarget::track);
  wish.obstacle = "its path can't be predicted";
  if (target == targets.end()) return {};
  auto plan = plan_observation(forces_, sky, sensor, *target, mount.position, start, last_,
                               best_detection_probability_);
  wish.obstacle = plan.reason;
  if (!plan) return {};
  return {{&*target, std::move(*plan), 0.0}};
}

Matrix6 Scheduler::known_of(const CueSky& sky, const CueTarget& target) const {
  Matrix6 known = Matrix6::Zero();
  for (const Task& task : pending_) {
    if (task.track != target.track) continue;
    const auto of = std::ranges::find(
        mounts_, task.sensor, [](const Mount& m) -> const std::string& { return m.sensor.name; });
    known += information_of(forces_, sky, of->sensor, task, target.estimate);
  }
  return known;
}

/// Works out the gains of all options, or of those of one track alone, and sorts them.
void Scheduler::weigh(const CueSky& sky, std::vector<Option>& options,
                      std::uint32_t of_track) const {
  for (Option& o : options)
    if (of_track == 0 || o.target->track == of_track)
      o.gain_nats = o.target->existence * o.plan.detection_probability *
                    gain_nats(o.target->estimate, known_of(sky, *o.target), o.plan.information);
  std::ranges::sort(options, [](const Option& a, const Option& b) {
    return a.rate() != b.rate() ? a.rate() > b.rate() : a.target->track < b.target->track;
  });
}

Task Scheduler::task_of(const Mount& mount, const std::vector<Option>& options, SimTime now) {
  const Option& best = options.front();
  const ObservationPlan& plan = best.plan;
  Task task{.id = next_id_++,
            .sensor = mount.sensor.name,
            .track = best.target->track,
            .catalogue_number = best.target->catalogue_number,
            .name = best.target->name,
            .given = now,
            .start = plan.start,
            .on_target = plan.on_target,
            .end = plan.end,
            .first_frame = plan.first_frame,
            .exposures = plan.exposures,
            .sigma_rad = plan.sigma_rad,
            .slew_rad = plan.slew_rad,
            .slew_s = plan.slew_s,
            .in_field = plan.in_field,
            .detection_probability = plan.detection_probability,
            .gain_nats = best.gain_nats,
            .gain_nats_per_s = best.rate()};
  for (const Option& o : options) task.candidates += o.gain_nats >= mount.sensor.cue.min_gain_nats;
  if (options.size() > 1) {
    task.runner_up = options[1].target->track;
    task.runner_up_nats_per_s = options[1].rate();
  }
  task.covariance = lower_triangle<6>(plan.at.covariance);
  const SimTime margin = sim_seconds(path_margin_s);
  put_path(forces_, plan.at.state, plan.on_target - margin, plan.end + margin, task);
  return task;
}

std::vector<Task> Scheduler::step(SimTime now, SimTime begin, SimTime next,
                                  std::span<const CueTarget> targets,
                                  std::vector<CueWish>* wishes) {
  // What a task finds is known some ticks after its end.
  const SimTime known{now.ns - heard_after_ticks * (next - begin).ns};
  std::erase_if(pending_, [&](const Task& t) { return t.end <= known; });
  std::vector<Task> out;
  if (wishes)
    for (CueWish& w : *wishes) w.obstacle = begin < last_ ? "it is busy" : "the run ends before";
  if (!is_asked(begin, next)) return out;
  const CueSky sky(clock_, begin, mounts_.front().sensor.site.ellipsoid);
  struct Free {
    Mount* mount;
    std::vector<Option> options;
  };
  std::vector<Free> free;
  for (Mount& mount : mounts_) {
    if (mount.free >= next) continue;
    const SimTime start = std::max(begin, mount.free);
    if (!wishes) free.push_back({&mount, options(sky, mount, start, targets)});
    if (wishes) {
      const auto wish = std::ranges::find(*wishes, mount.sensor.name, &CueWish::sensor);
      if (wish == wishes->end()) continue;
      free.push_back({&mount, wished(sky, mount, start, targets, *wish)});
    }
    weigh(sky, free.back().options, 0);
  }
  for (;;) {
    std::erase_if(free, [&](const Free& f) {
      return f.options.empty() ||
             (!wishes && (f.options.front().gain_nats < f.mount->sensor.cue.min_gain_nats ||
                          !(f.options.front().gain_nats > 0)));
    });
    if (free.empty()) break;
    const auto first =
        std::ranges::max_element(free, {}, [](const Free& f) { return f.options.front().rate(); });
    Task task = task_of(*first->mount, first->options, now);
    first->mount->position = first->options.front().plan.at_end;
    first->mount->free = task.end;
    free.erase(first);
    pending_.push_back(task);
    for (Free& f : free) weigh(sky, f.options, task.track);
    if (task.path_m.size() >= 6) out.push_back(std::move(task));
  }
  return out;
}

}  // namespace dmise
