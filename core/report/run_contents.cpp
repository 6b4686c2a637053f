#include "core/report/run_contents.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "core/base/error.h"
#include "core/base/paths.h"
#include "core/base/printable.h"
#include "core/base/text_file.h"
#include "core/base/units.h"
#include "core/image/fits_file.h"
#include "core/products/frame_file.h"
#include "core/score/json_record.h"
#include "core/score/run_files.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

double number_or(const JsonRecord& record, const char* key, double otherwise) {
  return record.has(key) ? record.number(key) : otherwise;
}

std::optional<double> optional_number(const JsonRecord& record, const char* key) {
  return record.has(key) ? std::optional(record.number(key)) : std::nullopt;
}

std::string text_or_empty(const JsonRecord& record, const char* key) {
  return record.has(key) ? record.get<std::string>(key) : std::string();
}

ReportSensor sensor_of(const JsonRecord& record) {
  return {.name = record.get<std::string>("name"),
          .site = site_of(record),
          .platform = text_or_empty(record, "platform"),
          .camera = record.has("camera") ? text_or_empty(record.object("camera"), "name")
                                         : "node " + text_or_empty(record, "node"),
          .exposure_s = number_or(record, "exposure_s", 0.0),
          .cadence_s = number_or(record, "cadence_s", 0.0),
          .camera_facts = camera_of(record)};
}

/// run.json, which a run that was killed leaves as it began it: with its digest alone.
void read_record(RunContents& run) {
  const std::string path = run.directory + "/run.json";
  if (!path_exists(path)) return;
  const JsonRecord record(read_text_file(path), path);
  run.status = record.get<std::string>("status");
  run.how = text_or_empty(record, "how");
  run.reason = text_or_empty(record, "reason");
  run.software = text_or_empty(record, "software");
  run.digest = text_or_empty(record, "digest");
  run.wall_s = optional_number(record, "wall_s");
  if (record.has("parts")) run.parts = record.get<int>("parts");
  if (record.has("nodes"))
    for (const JsonRecord& node : record.objects("nodes"))
      run.nodes.push_back({node.get<std::string>("name"), number_or(node, "compute_s", 0.0),
                           number_or(node, "messaging_s", 0.0), number_or(node, "waiting_s", 0.0),
                           number_or(node, "start_s", 0.0)});
  if (!record.has("scenario")) return;
  if (record.has("seed")) run.seed = record.get<std::uint64_t>("seed");
  const JsonRecord scenario = record.object("scenario");
  const JsonRecord simulation = scenario.object("simulation");
  run.start_utc = simulation.get<std::string>("start");
  run.duration_s = simulation.time("duration_ns").seconds();
  run.tick_s = simulation.time("tick_ns").seconds();
  if (scenario.has("stars"))
    run.star_catalogue = text_or_empty(scenario.object("stars"), "catalogue");
  for (const JsonRecord& sensor : scenario.objects("sensors")) {
    run.sensors.push_back(sensor_of(sensor));
    if (const std::string& name = run.sensors.back().name;
        name.empty() || name.find('/') != std::string::npos || name.starts_with('.'))
      sensor.fail("name", "can't be the name of a directory: " + printable(name));
  }
}

/// Adds sensors that have left frames and are not in run.json.
void find_sensors(RunContents& run) {
  std::set<std::string> known, more;
  for (const ReportSensor& s : run.sensors) known.insert(s.name);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(run.directory, error))
    if (entry.is_directory(error) && path_exists((entry.path() / "frames.jsonl").string()) &&
        !known.contains(entry.path().filename().string()))
      more.insert(entry.path().filename().string());
  if (error) throw ConfigError(run.directory + ": can't be read: " + error.message());
  for (const std::string& name : more) run.sensors.push_back({.name = name});
}

ReportFrame frame_of(const JsonRecord& line, std::size_t sensor) {
  ReportFrame f{.sensor = sensor,
                .number = line.get<std::uint32_t>("frame"),
                .middle = line.time("middle_ns"),
                .middle_utc = text_or_empty(line, "middle_utc"),
                .boresight_ra_rad = number_or(line, "boresight_ra_deg", 0.0) * deg,
                .boresight_dec_rad = number_or(line, "boresight_dec_deg", 0.0) * deg,
                .limiting_magnitude = optional_number(line, "limiting_magnitude"),
                .background_e = optional_number(line, "background_e"),
                .noise_e = optional_number(line, "noise_e")};
  if (f.limiting_magnitude) *f.limiting_magnitude -= number_or(line, "solar_colour_mag", 0.0);
  if (line.has("sensor_position_gcrs_m")) {
    const auto p = line.numbers<3>("sensor_position_gcrs_m");
    f.sensor_position_m = {p[0], p[1], p[2]};
  }
  for (const auto& [key, member] : {std::pair("stars_found", &ReportFrame::stars_found),
                                    std::pair("stars_expected", &ReportFrame::stars_expected)})
    if (line.has(key)) f.*member = line.get<std::uint32_t>(key);
  return f;
}

/// A line has the means over the `frames` up to its own.
void add_cost(const JsonRecord& line, ReportSensor& sensor, ReportFrame* frame) {
  const double total_s = line.number("total_s"), frames = number_or(line, "frames", 1.0);
  sensor.seconds_per_frame += frames * total_s;
  sensor.memory_mb = std::max(sensor.memory_mb, number_or(line, "pss_mb", 0.0));
  sensor.costs += std::size_t(frames);
  if (frame) frame->total_s = total_s;
  sensor.effects["detection"].measured_s += frames * number_or(line, "detection_s", 0.0);
  if (line.has("effects_s"))
    for (const auto& [effect, seconds] : line.object("effects_s").all_numbers())
      sensor.effects[effect].measured_s += frames * seconds;
  if (!line.has("plan")) return;
  const JsonRecord plan = line.object("plan");
  if (frame) frame->predicted_s = optional_number(plan, "predicted_s");
  for (const auto& [effect, planned] : plan.object("effects").all_objects()) {
    EffectCost& cost = sensor.effects[effect];
    cost.levels[planned.get<std::string>("level")] += std::size_t(frames);
    if (cost.why.empty()) cost.why = text_or_empty(planned, "why");
    if (!planned.has("predicted_s")) continue;
    cost.predicted_s += frames * planned.number("predicted_s");
    cost.planned_frames += std::size_t(frames);
  }
}

std::string key_of(const std::string& frame, const std::string& id) { return frame + "/" + id; }

/// What run.json would have said of a sensor, from its first frame.
void read_camera(const std::string& directory, ReportSensor& sensor) {
  std::error_code ignored;
  std::vector<std::string> frames;
  for (const auto& entry : fs::directory_iterator(directory, ignored))
    if (entry.path().filename().string().starts_with("frame-") &&
        entry.path().extension() == ".fits")
      frames.push_back(entry.path().string());
  if (frames.empty()) return;
  try {
    const Frame frame = read_frame(*std::ranges::min_element(frames));
    sensor.camera_facts.columns = frame.counts.columns;
    sensor.camera_facts.rows = frame.counts.rows;
    sensor.camera = frame.header.observation.telescope;
    sensor.exposure_s = frame.header.exposure_s;
    if (const auto& site = frame.header.site)
      sensor.site = {site->latitude_rad / deg, site->longitude_rad / deg, site->height_m};
  } catch (const Error&) {
    // It may be of another kind, such as sources, or cut short: the sensor stays without a size.
  }
}

/// Reads the lines of one sensor; those of a frame without a report are left out.
void read_sensor(RunContents& run, std::size_t index, ScoreInput& input) {
  ReportSensor& sensor = run.sensors[index];
  const std::string directory = run.directory + "/" + sensor.name + "/";
  std::map<std::uint32_t, std::size_t> places;
  if (!path_exists(directory + "frames.jsonl")) return;
  if (sensor.camera_facts.columns == 0) read_camera(directory, sensor);
  for_lines(directory + "frames.jsonl", quietly, [&](const JsonRecord& line) {
    ReportFrame f = frame_of(line, index);
    for (const auto& [ending, member] :
         {std::pair(".fits", &ReportFrame::fits), std::pair(".png", &ReportFrame::picture),
          std::pair("-marked.png", &ReportFrame::marked)})
      if (const std::string file = sensor.name + "/" + frame_file_name(f.number, ending);
          path_exists(run.directory + "/" + file))
        f.*member = file;
    if (!places.emplace(f.number, run.frames.size()).second)
      line.fail("frame", "is there twice: " + std::to_string(f.number));
    ScoredFrame scored = dmise::frame_of(line);
    scored.sensor = sensor.name;
    scored.columns = sensor.camera_facts.columns;
    scored.rows = sensor.camera_facts.rows;
    if (!scored.sigma_px) scored.sigma_px = sensor.camera_facts.sigma_px;
    if (scored.columns == 0) scored.searched = false;
    input.frames.push_back(std::move(scored));
    run.frames.push_back(std::move(f));
    ++sensor.frames;
  });
  const auto place_of = [&](std::uint32_t frame) -> std::optional<std::size_t> {
    const auto found = places.find(frame);
    return found == places.end() ? std::nullopt : std::optional(found->second);
  };
  if (path_exists(directory + "truth.jsonl")) {
    run.has_truth = true;
    for_lines(directory + "truth.jsonl", quietly, [&](const JsonRecord& line) {
      Truth truth = truth_of(line);
      const auto frame = place_of(truth.frame);
      if (!frame) return;
      truth.sensor = sensor.name;
      input.truths.push_back(source_of(truth));
      run.truths.push_back({*frame, std::move(truth)});
    });
  }
  if (path_exists(directory + "detections.jsonl"))
    for_lines(directory + "detections.jsonl", quietly, [&](const JsonRecord& line) {
      Detection d = detection_of(line);
      const auto frame = place_of(d.frame);
      if (!frame) return;
      d.sensor = sensor.name;
      ++sensor.detections;
      input.detections.push_back(
          {.sensor = sensor.name, .frame = std::to_string(d.frame), .detection = d});
      run.detections.push_back({*frame, std::move(d)});
    });
  if (path_exists(directory + "cost.jsonl"))
    for_lines(directory + "cost.jsonl", quietly, [&](const JsonRecord& line) {
      const auto frame = place_of(line.get<std::uint32_t>("frame"));
      add_cost(line, sensor, frame ? &run.frames[*frame] : nullptr);
    });
  if (sensor.costs > 0) sensor.seconds_per_frame /= double(sensor.costs);
  if (path_exists(run.directory + "/logs/" + sensor.name + ".log"))
    sensor.log = "logs/" + sensor.name + ".log";
}

/// Scores the run, and marks which truth was found and which detection is of a truth.
void judge(RunContents& run, ScoreInput input) {
  input.source = run.directory;
  input.status = run.status;
  run.score = score(std::move(input), {});
  std::map<std::string, std::size_t> scored;
  for (std::size_t k = 0; k < run.score.truths.size(); ++k) {
    const TrueSource& t = run.score.truths[k].truth;
    scored.emplace(key_of(t.sensor + "/" + t.frame, t.id), k);
  }
  for (ReportTruth& t : run.truths)
    t.scored = scored.at(
        key_of(t.truth.sensor + "/" + std::to_string(t.truth.frame), source_of(t.truth).id));
  std::erase_if(run.truths, [&](const ReportTruth& t) {
    return run.score.truths[t.scored].fate == Fate::outside;
  });
  std::set<std::string> false_alarms;
  for (const FoundSource& d : run.score.false_alarms) false_alarms.insert(d.detection.id);
  for (ReportDetection& d : run.detections) d.of_truth = !false_alarms.contains(d.detection.id);
}

std::string first_of(const std::string& directory, const char* name) {
  for (const std::string& path : {directory + "/" + name, directory + "/fusion-node/" + name})
    if (path_exists(path)) return path;
  return "";
}

void read_tracks(RunContents& run) {
  constexpr std::size_t most_points = 400;  // of a track
  std::map<std::uint32_t, ReportTrack> tracks;
  if (const std::string path = first_of(run.directory, "tracks.jsonl"); !path.empty())
    for_lines(path, quietly, [&](const JsonRecord& line) {
      const Track t = track_of(line);
      const auto [found, is_new] = tracks.try_emplace(t.id);
      ReportTrack& track = found->second;
      const double time_s = t.time.seconds();
      if (is_new) track.first_s = time_s;
      track.last = t;
      const double variance = t.covariance[0] + t.covariance[2] + t.covariance[5];
      if (variance > 0.0) track.sigma_m.emplace_back(time_s, std::sqrt(variance));
    });
  if (const std::string path = first_of(run.directory, "tasks.jsonl"); !path.empty())
    for_lines(path, quietly, [&](const JsonRecord& line) {
      Task cue{.id = line.get<std::uint32_t>("id"),
               .sensor = line.get<std::string>("sensor"),
               .track = line.get<std::uint32_t>("track"),
               .name = text_or_empty(line, "name"),
               .on_target = line.time("on_target_ns"),
               .end = line.time("end_ns"),
               .exposures = line.get<std::uint32_t>("exposures"),
               .gain_nats = line.number("gain_nats")};
      cue.catalogue_number = line.get<std::uint32_t>("catalogue_number");
      if (const auto track = tracks.find(cue.track); track != tracks.end()) ++track->second.cues;
      run.cues.push_back(std::move(cue));
    });
  for (auto& [id, track] : tracks) {
    auto& points = track.sigma_m;
    if (const std::size_t every = (points.size() + most_points - 1) / most_points; every > 1) {
      std::size_t kept = 0;
      for (std::size_t k = 0; k < points.size(); k += every) points[kept++] = points[k];
      points.resize(kept);
    }
    run.tracks.push_back(std::move(track));
  }
}

/// Reads what the time-masters of `dmise launch` report of their ticks: of each part of the run
/// one, after those before it.
void read_ticks(RunContents& run) {
  double before_s = 0.0;
  const auto read = [&](const std::string& path) {
    const JsonRecord record(read_text_file(path), path);
    if (record.has("waited_for_s"))
      for (const auto& [name, seconds] : record.object("waited_for_s").all_numbers())
        run.waited_for_s[name] += seconds;
    if (record.has("ticks"))
      for (const JsonRecord& tick : record.objects("ticks"))
        run.ticks.push_back({tick.get<Tick>("tick"), before_s + tick.number("granted_s"),
                             before_s + tick.number("settled_s"), text_or_empty(tick, "last")});
    before_s += number_or(record, "wall_s", 0.0);
  };
  const std::string logs = run.directory + "/logs/master";
  const auto of_part = [&](int part) { return logs + "-" + std::to_string(part) + ".json"; };
  for (int part = 1; path_exists(of_part(part)); ++part) read(of_part(part));
  if (path_exists(logs + ".json")) read(logs + ".json");
}

void find_files(RunContents& run) {
  for (const char* name : {"run.json", "frames.jsonl", "detections.jsonl", "truth.jsonl",
                           "tracks.jsonl", "tasks.jsonl", "positions.csv", "positions.jsonl"})
    if (path_exists(run.directory + "/" + name)) run.files.push_back(name);
  std::vector<std::string> logs;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(run.directory + "/logs", ignored))
    if (entry.is_regular_file(ignored)) logs.push_back("logs/" + entry.path().filename().string());
  std::ranges::sort(logs);
  run.files.insert(run.files.end(), logs.begin(), logs.end());
}

}  // namespace

RunContents read_contents(const std::string& directory) {
  RunContents run{.directory = directory};
  read_record(run);
  find_sensors(run);
  ScoreInput input;
  for (std::size_t k = 0; k < run.sensors.size(); ++k) read_sensor(run, k, input);
  if (run.sensors.empty())
    throw ConfigError(directory + ": no run: neither run.json nor a sensor with frames.jsonl");
  judge(run, std::move(input));
  read_tracks(run);
  read_ticks(run);
  find_files(run);
  return run;
}

}  // namespace dmise
