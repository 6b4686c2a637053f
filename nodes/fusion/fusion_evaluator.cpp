#include "nodes/fusion/fusion_evaluator.h"

#include <algorithm>
#include <map>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/config/fusion_config.h"
#include "core/config/objects/object_names.h"
#include "core/products/frame_report.h"
#include "core/products/product_json.h"
#include "core/run/run_files.h"
#include "core/time/iso8601.h"
#include "nodes/fusion/filter_tracker.h"
#include "nodes/fusion/own_tracker.h"

namespace dmise {
namespace {

/// Frames with their detections, by sensor and number.
std::vector<SearchedFrame> searched_frames(std::span<const Message> inputs) {
  std::map<std::pair<std::string, std::uint32_t>, SearchedFrame> frames;
  for (const Message& message : inputs) {
    if (const auto* report = std::get_if<FrameReport>(message.state.get()))
      frames[{report->sensor, report->frame}].report = report;
    if (const auto* set = std::get_if<DetectionSet>(message.state.get()))
      frames[{set->sensor, set->frame}].found = set;
  }
  std::vector<SearchedFrame> out;
  for (const auto& [key, frame] : frames)
    if (frame.report && frame.found) out.push_back(frame);  // else one of them was lost
  return out;
}

}  // namespace

std::optional<CuedSensor> cued_sensor(const SensorConfig& sensor) {
  const auto* cued = std::get_if<PointCued>(&sensor.pointing);
  if (!cued) return std::nullopt;
  const Optics& optics = sensor.camera.optics;
  CueSettings cue = cued->cue;
  if (const Exclusion& e = sensor.camera.exclusion; e.action == ExclusionAction::close_shutter) {
    cue.sun_exclusion_deg = std::max(cue.sun_exclusion_deg, e.sun_deg.value_or(0.0));
    cue.moon_exclusion_deg = std::max(cue.moon_exclusion_deg, e.moon_deg.value_or(0.0));
  }
  return CuedSensor{
      .name = sensor.name,
      .site = *site_of(sensor),
      .cue = cue,
      .park_azimuth_deg = cued->park.azimuth_deg,
      .park_elevation_deg = cued->park.elevation_deg,
      .half_angle_rad = optics.pixel_angle_rad() * std::min(optics.columns, optics.rows) / 2,
      .exposure_s = sensor.exposure_s,
      .cadence_s = sensor.cadence_s,
      .first_exposure_s = sensor.first_exposure_s};
}

FusionEvaluator::FusionEvaluator(const Scenario& scenario, Clock clock,
                                 const std::string& directory, OwnNodeSettings settings)
    : scenario_(scenario),
      clock_(std::move(clock)),
      directory_(directory),
      settings_(std::move(settings)),
      journal_(input_journal_path(directory, fusion_node)) {
  std::vector<CuedSensor> cued;
  for (const SensorConfig& sensor : scenario.sensors)
    if (auto one = cued_sensor(sensor)) {
      cued_.push_back(one->name);
      cued.push_back(std::move(*one));
    }
  if (!cued.empty())
    scheduler_.emplace(clock_, SimTime{scenario.duration.ns / 2}, std::move(cued),
                       scenario.duration, scenario.fusion->settings.detection_probability);
  if (scenario.fusion->node.empty()) return;
  settings_.log_path = directory + "/logs/" + scenario.fusion->node + ".log";
  settings_.error_prefix += scenario.fusion->node + ": ";
}

std::vector<std::string> FusionEvaluator::produces() const {
  std::vector<std::string> topics{std::string(track_prefix) + fusion_node};
  for (const std::string& sensor : cued_) topics.push_back(task_prefix + sensor);
  return topics;
}

std::vector<std::string> FusionEvaluator::consumes() const {
  std::vector<std::string> topics{roster_topic};
  for (const SensorConfig& sensor : scenario_.sensors)
    for (const char* prefix : {frame_prefix, detection_prefix})
      if (sensor.detect) topics.push_back(prefix + sensor.name);
  return topics;
}

void FusionEvaluator::start_with(const ObjectRoster& roster) {
  ObjectRoster known;
  const auto is_unknown = [&](const auto& object) {
    return std::ranges::any_of(scenario_.fusion->not_in_catalogue,
                               [&](const auto& name) { return is_called(object, name); });
  };
  if (!scenario_.fusion->catalogue_path.empty()) {
    for (const MeanElements& e : believed_elements(*scenario_.fusion, clock_.utc({0}))) {
      if (is_unknown(e)) continue;
      known.objects.push_back({.catalogue_number = e.catalogue_number, .name = printable(e.name)});
      known.elements.push_back(e);
    }
  } else {
    for (std::size_t i = 0; i < roster.elements.size(); ++i) {
      if (is_unknown(roster.objects[i])) continue;
      known.objects.push_back(roster.objects[i]);
      known.elements.push_back(roster.elements[i]);
    }
  }
  if (scenario_.fusion->node.empty()) {
    tracker_ = std::make_unique<FilterTracker>(scenario_, known, clock_);
    return;
  }
  const auto replay = [this](Tick from, Tick before, const OwnTracker::Again& again) {
    journal_.replay(from, before, [&](Tick tick, std::span<const Message> inputs) {
      ++progress_;
      again(tick, searched_frames(inputs));
    });
  };
  tracker_ = std::make_unique<OwnTracker>(scenario_, known, clock_, settings_, replay);
}

std::optional<FusionEvaluator::Found> FusionEvaluator::fuse(Tick tick,
                                                            std::span<const Message> inputs) {
  for (const Message& message : inputs)
    if (const auto* roster = std::get_if<ObjectRoster>(message.state.get())) {
      knows_roster_ = true;
      if (!tracker_) start_with(*roster);
    }
  if (!tracker_) throw Error("no roster came before tick " + std::to_string(tick));
  auto tracked = tracker_->step(tick, searched_frames(inputs));
  ++progress_;
  if (!tracked) return std::nullopt;
  FusionTick& found = tracked->tracks;
  if (!tracked->tasks)
    tracked->tasks = tasks_of(tick, tracked->wishes ? &*tracked->wishes : nullptr);
  return Found{.tracks = {.tick = tick,
                          .time = scenario_.time_of(tick),
                          .node = fusion_node,
                          .live = found.live,
                          .unassociated = found.unassociated,
                          .tracks = std::move(found.tracks)},
               .tasks = std::move(*tracked->tasks),
               .orbits = std::move(found.orbits),
               .breakups = std::move(found.breakups)};
}

std::vector<Task> FusionEvaluator::tasks_of(Tick tick, std::vector<CueWish>* wishes) {
  if (!scheduler_) return {};
  const Tick delay = scenario_.fusion->cue_delay_ticks;
  const SimTime begin = scenario_.time_of(tick + delay), next = scenario_.time_of(tick + delay + 1);
  const bool asked = scheduler_->is_asked(begin, next) && !(wishes && wishes->empty());
  if (!asked && !wishes) return {};
  const SimTime now = scenario_.time_of(tick);
  auto tasks = scheduler_->step(now, begin, next,
                                asked ? tracker_->targets(now) : std::vector<CueTarget>{}, wishes);
  if (wishes) note_obstacles(tick, *wishes);
  return tasks;
}

void FusionEvaluator::note_obstacles(Tick tick, const std::vector<CueWish>& wishes) {
  for (const CueWish& wish : wishes)
    if (!wish.obstacle.empty() && noted_.insert({wish.sensor, wish.obstacle}).second)
      settings_.note(scenario_.fusion->node + ": " + wish.sensor + " can't observe track " +
                     std::to_string(wish.track) + " of tick " + std::to_string(tick) + ": " +
                     std::string(wish.obstacle));
}

void FusionEvaluator::open_files(Tick tick) {
  const SimTime from = scenario_.time_of(tick);
  tracks_.emplace(path_in(directory_, run_file::tracks), "time_ns", from);
  if (scheduler_) tasks_.emplace(path_in(directory_, run_file::tasks), "given_ns", from);
  if (scenario_.fusion->settings.keep_orbits) {
    orbits_.emplace(path_in(directory_, run_file::orbits), "kept_ns", from);
    breakups_.emplace(path_in(directory_, run_file::breakups), "announced_ns", from);
  }
  begun_ = true;
}

void FusionEvaluator::write(const Found& found) {
  const auto utc = [&](SimTime t) { return format_utc(clock_.utc(t), 9); };
  const auto add = [&](std::optional<LineFile>& file, const auto& products) {
    std::string lines;
    for (const auto& product : products) lines += to_json(product, utc) + "\n";
    if (file) file->add(lines);
  };
  add(tracks_, found.tracks.tracks);
  add(tasks_, found.tasks);
  add(orbits_, found.orbits);
  add(breakups_, found.breakups);
}

std::vector<Message> FusionEvaluator::resume(Tick tick, std::span<const Message>) {
  journal_.resume(tick, [&](Tick k, std::span<const Message> inputs) { fuse(k, inputs); });
  open_files(tick);
  return {};
}

std::vector<Message> FusionEvaluator::step(Tick tick, std::span<const Message> inputs) {
  if (!begun_) {
    journal_.clear();
    open_files(0);
  }
  // A process that continues a run receives the roster again; the journal has it already.
  std::vector<Message> fresh;
  for (const Message& message : inputs)
    if (!knows_roster_ || !std::holds_alternative<ObjectRoster>(*message.state))
      fresh.push_back(message);
  journal_.add(fresh);
  auto fused = fuse(tick, fresh);
  if (!fused) return {};  // the tick stays without its end in the journal
  Found& found = *fused;
  write(found);
  journal_.end(tick);
  const SimTime time = found.tracks.time;
  std::vector<Message> messages{{std::string(track_prefix) + fusion_node, tick,
                                 std::make_shared<State>(std::move(found.tracks))}};
  for (const std::string& sensor : cued_) {
    TaskSet set{.tick = tick, .time = time, .node = fusion_node, .sensor = sensor, .tasks = {}};
    for (const Task& task : found.tasks)
      if (task.sensor == sensor) set.tasks.push_back(task);
    if (!set.tasks.empty())
      messages.push_back({task_prefix + sensor, tick, std::make_shared<State>(std::move(set))});
  }
  return messages;
}

}  // namespace dmise
