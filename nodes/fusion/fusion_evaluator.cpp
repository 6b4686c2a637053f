#include "nodes/fusion/fusion_evaluator.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "core/optics/projection.h"
#include "core/products/track_json.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr double axis_slack_rad = 0.01;  // the boresight of a report is that of the stars

/// Time of a line of tracks.jsonl [ns].
std::int64_t time_of(const std::string& line) {
  constexpr std::string_view key = "\"time_ns\":";
  const auto at = line.find(key);
  return at == std::string::npos ? 0 : std::strtoll(line.c_str() + at + key.size(), nullptr, 10);
}

}  // namespace

std::string fusion_journal_path(const std::string& directory) {
  return directory + "/" + fusion_node + "/inputs.journal";
}

FusionEvaluator::FusionEvaluator(const Scenario& scenario, Clock clock,
                                 const std::string& directory)
    : scenario_(scenario),
      clock_(std::move(clock)),
      tracks_path_(directory + "/tracks.jsonl"),
      journal_(fusion_journal_path(directory)) {
  for (const SensorConfig& sensor : scenario.sensors) {
    if (!sensor.detect) continue;
    const Optics& optics = sensor.camera.optics;
    cameras_[sensor.name] = {optics.columns, optics.rows,
                             std::min(half_diagonal_rad(optics) + axis_slack_rad, pi)};
  }
}

FusionEvaluator::~FusionEvaluator() {
  if (tracks_) std::fclose(tracks_);
}

std::vector<std::string> FusionEvaluator::produces() const {
  return {std::string(track_prefix) + fusion_node};
}

std::vector<std::string> FusionEvaluator::consumes() const {
  std::vector<std::string> topics{roster_topic};
  for (const auto& [sensor, camera] : cameras_)
    for (const char* prefix : {frame_prefix, detection_prefix}) topics.push_back(prefix + sensor);
  return topics;
}

void FusionEvaluator::meet(const ObjectRoster& roster) {
  const FusionConfig& config = *scenario_.fusion;
  const auto is_called = [&](std::size_t i, const std::string& name) {
    const ObjectInfo& object = roster.objects[i];
    return object.name == name || std::to_string(object.catalogue_number) == name;
  };
  for (std::size_t k = 0; k < config.not_in_catalogue.size(); ++k) {
    bool found = false;
    for (std::size_t i = 0; i < roster.objects.size() && !found; ++i)
      found = is_called(i, config.not_in_catalogue[k]);
    if (!found)
      throw ConfigError(config.not_in_catalogue_where[k] +
                        ": no object has this name or number, got " + config.not_in_catalogue[k]);
  }
  std::vector<MeanElements> catalogue;
  for (std::size_t i = 0; i < roster.elements.size(); ++i) {
    if (std::ranges::any_of(config.not_in_catalogue,
                            [&](const auto& name) { return is_called(i, name); }))
      continue;
    catalogue.push_back(roster.elements[i]);
    catalogue.back().catalogue_number = roster.objects[i].catalogue_number;
    catalogue.back().name = roster.objects[i].name;
  }
  fusion_.emplace(std::move(catalogue), clock_, SimTime{scenario_.duration.ns / 2},
                  config.settings);
}

TrackSet FusionEvaluator::fuse(Tick tick, std::span<const Message> inputs) {
  std::map<std::pair<std::string, std::uint32_t>,
           std::pair<const FrameReport*, const DetectionSet*>>
      exposures;
  for (const Message& message : inputs) {
    if (const auto* roster = std::get_if<ObjectRoster>(message.state.get()))
      if (!fusion_) meet(*roster);
    if (const auto* report = std::get_if<FrameReport>(message.state.get()))
      exposures[{report->sensor, report->frame}].first = report;
    if (const auto* set = std::get_if<DetectionSet>(message.state.get()))
      exposures[{set->sensor, set->frame}].second = set;
  }
  std::vector<SensorFrame> frames;
  for (const auto& [key, exposure] : exposures) {
    const auto& [report, set] = exposure;
    if (!report || !set) continue;  // a lost one
    const Camera& camera = cameras_.at(key.first);
    frames.push_back(
        sensor_frame(*report, set->detections, camera.columns, camera.rows, camera.half_angle_rad));
  }
  TrackSet out{.tick = tick, .time = scenario_.time_of(tick), .node = fusion_node};
  if (!fusion_) throw Error("no roster came before tick " + std::to_string(tick));
  FusionTick found = fusion_->step(out.time, std::move(frames));
  out.live = found.live;
  out.unassociated = found.unassociated;
  out.tracks = std::move(found.tracks);
  ++progress_;
  return out;
}

void FusionEvaluator::open_tracks(Tick tick) {
  std::string kept;
  {
    std::ifstream file(tracks_path_);
    std::string line;
    while (tick > 0 && std::getline(file, line) && !file.eof())
      if (time_of(line) < scenario_.time_of(tick).ns) kept += line + "\n";
  }
  write_file_whole(tracks_path_, kept);
  tracks_ = std::fopen(tracks_path_.c_str(), "ab");
  if (!tracks_) throw Error(tracks_path_ + ": can't be written: " + std::strerror(errno));
  begun_ = true;
}

void FusionEvaluator::write(const TrackSet& set) {
  std::string lines;
  const auto utc = [&](SimTime t) { return format_utc(clock_.utc(t), 9); };
  for (const Track& track : set.tracks) lines += to_json(track, utc) + "\n";
  if (std::fwrite(lines.data(), 1, lines.size(), tracks_) != lines.size() ||
      std::fflush(tracks_) != 0)
    throw Error(tracks_path_ + ": can't be written: " + std::strerror(errno));
}

std::vector<Message> FusionEvaluator::resume(Tick tick, std::span<const Message>) {
  journal_.resume(tick, [&](Tick k, std::span<const Message> inputs) { fuse(k, inputs); });
  open_tracks(tick);
  return {};
}

std::vector<Message> FusionEvaluator::step(Tick tick, std::span<const Message> inputs) {
  if (!begun_) {
    journal_.clear();
    open_tracks(0);
  }
  // A process that goes on hears the roster again; the journal has it.
  std::vector<Message> fresh;
  for (const Message& message : inputs)
    if (!fusion_ || !std::holds_alternative<ObjectRoster>(*message.state)) fresh.push_back(message);
  journal_.add(fresh);
  TrackSet set = fuse(tick, fresh);
  write(set);
  journal_.end(tick);
  return {{std::string(track_prefix) + fusion_node, tick, std::make_shared<State>(std::move(set))}};
}

}  // namespace dmise
