#include "tests/support/cue_trial.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/fusion/fusion.h"
#include "core/fusion/scheduler.h"
#include "core/orbit/interpolation.h"
#include "core/orbit/sgp4/synthetic_catalogue.h"
#include "tests/support/fusion_trial.h"

namespace dmise {
namespace {

constexpr double tick_s = 5.0;
constexpr int wide_every = 2;  // ticks
constexpr int cue_delay_ticks = 2;
constexpr int measured_after_ticks = 2;
constexpr int telescopes = 2;

Vec<Gcrs> point(const std::vector<double>& xyz, std::size_t i) {
  return {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
}

/// Where the sensor points that follows a task.
Vec<Gcrs> axis_of(const Task& task, SimTime t, const Vec<Gcrs>& sensor_m) {
  const double steps = (t - task.path_start).seconds() / task.path_step_s;
  const auto i = std::min(std::size_t(steps), task.path_m.size() / 3 - 2);
  const Vec<Gcrs> r = interpolate_cubic(steps - double(i), task.path_step_s, point(task.path_m, i),
                                        point(task.path_m_per_s, i), point(task.path_m, i + 1),
                                        point(task.path_m_per_s, i + 1));
  const Vec<Gcrs> line = r - sensor_m;
  return unit(line - point(task.path_m_per_s, i) * (norm(line) / speed_of_light_m_per_s));
}

double sigma_m(const CueTarget& target) {
  return std::sqrt(target.estimate.covariance.topLeftCorner<3, 3>().trace());
}

}  // namespace

std::vector<CueOutcome> cue_trial(const CueTrialSettings& settings) {
  // Each seed has another quarter of an hour of the evening.
  const Clock clock(Utc{2458138.5, double(settings.seed % 12) * 300.0 / 86400.0});
  FusionTrialSettings network;
  for (int k = 0; k < 8; ++k)
    network.sites.push_back({32 + 3.6 * (k / 4), -88 + 4.2 * (k % 4), 200.0});
  network.half_angle_rad = 50 * deg;
  network.sigma_rad = 20 * arcsec;
  network.detection_probability = settings.detection_probability;
  network.false_alarms_per_frame = 0.5;
  network.limiting_magnitude = 7.0;
  network.seed = settings.seed;
  const std::size_t first = std::size_t(settings.seed) * settings.objects;
  FusionTrial trial(synthetic_catalogue({.objects = settings.objects, .first = first}), clock,
                    network);
  FusionSettings fused;
  Fusion fusion({}, clock, {}, fused);

  std::vector<CuedSensor> sensors;
  for (int k = 0; k < telescopes; ++k)
    sensors.push_back({.name = "telescope" + std::to_string(k),
                       .site = network.sites[std::size_t(3 * k)],
                       .cue = {.slew_deg_per_s2 = 3.0, .limiting_magnitude = 12.0},
                       .half_angle_rad = 0.65 * deg,
                       .exposure_s = 0.5,
                       .cadence_s = 2.5});
  const SimTime end = sim_seconds(settings.ticks * tick_s);
  Scheduler scheduler(clock, {}, sensors, end, fused.detection_probability);

  std::map<std::uint32_t, CueOutcome> outcomes;
  std::vector<Task> tasks;
  std::map<std::uint32_t, std::map<std::uint32_t, int>> objects_of;  // by track: detections
  const auto time_of = [](int tick) { return sim_seconds(tick * tick_s); };
  for (int k = 0; k <= settings.ticks; ++k) {
    const SimTime now = time_of(k);
    std::vector<SensorFrame> frames;
    if (k % wide_every == 0) frames = trial.frames(now, std::uint32_t(k / wide_every + 1));
    // Exposures of telescopes that ended since the last tick.
    std::map<std::string, std::uint32_t> task_of;  // by detection
    for (const CuedSensor& sensor : sensors)
      for (std::uint32_t n = sensor.first_frame_from(time_of(k - 2));; ++n) {
        const SimTime begins = sensor.exposure_start(n), ends = begins + sim_seconds(0.5);
        if (ends > now) break;
        if (k == 0 || ends <= time_of(k - 1)) continue;
        const auto task = std::ranges::find_if(tasks, [&](const Task& t) {
          return t.sensor == sensor.name && t.on_target <= begins && t.end >= ends;
        });
        if (task == tasks.end()) continue;
        ++outcomes[task->id].exposures;
        const SimTime middle = begins + sim_seconds(0.25);
        const Vec<Gcrs> here = earth_orientation(clock, middle).itrs_from_gcrs(middle).inverse() *
                               itrs_from_geodetic(sensor.site);
        frames.push_back(trial.frame_of({.name = sensor.name,
                                         .site = sensor.site,
                                         .half_angle_rad = sensor.half_angle_rad,
                                         .sigma_rad = sensor.cue.sigma_arcsec * arcsec,
                                         .limiting_magnitude = sensor.cue.limiting_magnitude},
                                        axis_of(*task, middle, here), middle, n));
        for (const SeenSource& s : frames.back().sources)
          task_of[s.observation.detection_id] = task->id;
      }
    const FusionTick found = fusion.step(now, std::move(frames));
    for (const Track& track : found.tracks)
      for (const std::string& id : track.associated) {
        ++objects_of[track.id][trial.truth(id)];
        const auto of = task_of.find(id);
        if (of == task_of.end()) continue;
        CueOutcome& outcome = outcomes.at(of->second);
        if (outcome.track != track.id) continue;  // another object is in the field
        const auto task = std::ranges::find(tasks, of->second, &Task::id);
        const auto frame = std::stoul(id.substr(id.find('/') + 1));
        const int exposure = int(frame) - int(task->first_frame) + 1;
        if (outcome.first_detection == 0 || exposure < outcome.first_detection)
          outcome.first_detection = exposure;
      }
    const auto targets = fusion.targets(now);
    const auto target_of = [&](std::uint32_t track) {
      return std::ranges::find(targets, track, &CueTarget::track);
    };
    for (auto& [id, outcome] : outcomes) {
      if (outcome.sigma_after_m > 0 || outcome.end > time_of(k - measured_after_ticks)) continue;
      const auto target = target_of(outcome.track);
      outcome.sigma_after_m = target == targets.end() ? HUGE_VAL : sigma_m(*target);
    }
    for (Task& task : scheduler.step(now, time_of(k + cue_delay_ticks),
                                     time_of(k + cue_delay_ticks + 1), targets)) {
      outcomes[task.id] = {.id = task.id,
                           .track = task.track,
                           .slew_deg = task.slew_rad / deg,
                           .slew_s = task.slew_s,
                           .in_field = task.in_field,
                           .sigma_before_m = sigma_m(*target_of(task.track)),
                           .given = task.given,
                           .on_target = task.on_target,
                           .end = task.end};
      tasks.push_back(std::move(task));
    }
  }
  std::vector<CueOutcome> out;
  for (auto& [id, outcome] : outcomes) {
    int most = 0;
    for (const auto& [object, detections] : objects_of[outcome.track])
      if (detections > most) most = detections, outcome.object = object;
    out.push_back(outcome);
  }
  return out;
}

}  // namespace dmise
