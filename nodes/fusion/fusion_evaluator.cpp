#include "nodes/fusion/fusion_evaluator.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/config/object_names.h"
#include "core/optics/projection.h"
#include "core/products/frame_report.h"
#include "core/products/task_json.h"
#include "core/products/track_json.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr double axis_slack_rad = 0.01;  // the boresight of a report is that of the stars

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
                                 const std::string& directory)
    : scenario_(scenario),
      clock_(std::move(clock)),
      directory_(directory),
      journal_(fusion_journal_path(directory)) {
  std::vector<CuedSensor> cued;
  for (const SensorConfig& sensor : scenario.sensors) {
    if (auto one = cued_sensor(sensor)) {
      cued_.push_back(one->name);
      cued.push_back(std::move(*one));
    }
    if (!sensor.detect) continue;
    const Optics& optics = sensor.camera.optics;
    cameras_[sensor.name] = {optics.columns, optics.rows,
                             std::min(half_diagonal_rad(optics) + axis_slack_rad, pi)};
  }
  if (!cued.empty())
    scheduler_.emplace(clock_, SimTime{scenario.duration.ns / 2}, std::move(cued),
                       scenario.duration, scenario.fusion->settings.detection_probability);
}

std::vector<std::string> FusionEvaluator::produces() const {
  std::vector<std::string> topics{std::string(track_prefix) + fusion_node};
  for (const std::string& sensor : cued_) topics.push_back(task_prefix + sensor);
  return topics;
}

std::vector<std::string> FusionEvaluator::consumes() const {
  std::vector<std::string> topics{roster_topic};
  for (const auto& [sensor, camera] : cameras_)
    for (const char* prefix : {frame_prefix, detection_prefix}) topics.push_back(prefix + sensor);
  return topics;
}

void FusionEvaluator::start_with(const ObjectRoster& roster) {
  const FusionConfig& config = *scenario_.fusion;
  std::vector<MeanElements> catalogue;
  for (std::size_t i = 0; i < roster.elements.size(); ++i) {
    if (std::ranges::any_of(config.not_in_catalogue,
                            [&](const auto& name) { return is_called(roster.objects[i], name); }))
      continue;
    catalogue.push_back(roster.elements[i]);
    catalogue.back().catalogue_number = roster.objects[i].catalogue_number;
    catalogue.back().name = roster.objects[i].name;
  }
  fusion_.emplace(std::move(catalogue), clock_, SimTime{scenario_.duration.ns / 2},
                  config.settings);
}

FusionEvaluator::Found FusionEvaluator::fuse(Tick tick, std::span<const Message> inputs) {
  std::map<std::pair<std::string, std::uint32_t>,
           std::pair<const FrameReport*, const DetectionSet*>>
      exposures;
  for (const Message& message : inputs) {
    if (const auto* roster = std::get_if<ObjectRoster>(message.state.get()))
      if (!fusion_) start_with(*roster);
    if (const auto* report = std::get_if<FrameReport>(message.state.get()))
      exposures[{report->sensor, report->frame}].first = report;
    if (const auto* set = std::get_if<DetectionSet>(message.state.get()))
      exposures[{set->sensor, set->frame}].second = set;
  }
  std::vector<SensorFrame> frames;
  for (const auto& [key, exposure] : exposures) {
    const auto& [report, set] = exposure;
    if (!report || !set) continue;  // one of them was lost
    const Camera& camera = cameras_.at(key.first);
    frames.push_back(sensor_frame(*report, set->detections, camera.columns, camera.rows,
                                  camera.half_angle_rad,
                                  scenario_.fusion->settings.pointing_sigma_arcsec * arcsec));
  }
  TrackSet out{.tick = tick, .time = scenario_.time_of(tick), .node = fusion_node};
  if (!fusion_) throw Error("no roster came before tick " + std::to_string(tick));
  FusionTick found = fusion_->step(out.time, std::move(frames));
  out.live = found.live;
  out.unassociated = found.unassociated;
  out.tracks = std::move(found.tracks);
  ++progress_;
  return {std::move(out), tasks_of(tick)};
}

std::vector<Task> FusionEvaluator::tasks_of(Tick tick) {
  const Tick delay = scenario_.fusion->cue_delay_ticks;
  const SimTime begin = scenario_.time_of(tick + delay), next = scenario_.time_of(tick + delay + 1);
  if (!scheduler_ || !scheduler_->is_asked(begin, next)) return {};
  const SimTime now = scenario_.time_of(tick);
  return scheduler_->step(now, begin, next, fusion_->targets(now));
}

void FusionEvaluator::open_files(Tick tick) {
  const SimTime from = scenario_.time_of(tick);
  tracks_.emplace(directory_ + "/tracks.jsonl", "time_ns", from);
  if (scheduler_) tasks_.emplace(directory_ + "/tasks.jsonl", "given_ns", from);
  begun_ = true;
}

void FusionEvaluator::write(const Found& found) {
  std::string lines;
  const auto utc = [&](SimTime t) { return format_utc(clock_.utc(t), 9); };
  for (const Track& track : found.tracks.tracks) lines += to_json(track, utc) + "\n";
  tracks_->add(lines);
  lines.clear();
  for (const Task& task : found.tasks) lines += to_json(task, utc) + "\n";
  if (tasks_) tasks_->add(lines);
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
    if (!fusion_ || !std::holds_alternative<ObjectRoster>(*message.state)) fresh.push_back(message);
  journal_.add(fresh);
  Found found = fuse(tick, fresh);
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
