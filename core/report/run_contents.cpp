#include "core/report/run_contents.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "core/base/error.h"
#include "core/base/files/json_record.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/base/units.h"
#include "core/image/fits_file.h"
#include "core/products/frame_file.h"
#include "core/products/product_json.h"
#include "core/run/run_files.h"
#include "core/score/scored_run.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

std::optional<double> optional_number(const JsonRecord& record, const char* key) {
  return record.has(key) ? std::optional(record.number(key)) : std::nullopt;
}

/// Adds sensors that have left frames and are not in run.json.
void find_sensors(RunContents& run) {
  std::set<std::string> known, more;
  for (const ReportSensor& s : run.sensors) known.insert(s.sensor.name);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(run.directory, error))
    if (entry.is_directory(error) &&
        path_exists(path_in(entry.path().string(), run_file::frames)) &&
        !known.contains(entry.path().filename().string()))
      more.insert(entry.path().filename().string());
  if (error) throw ConfigError(run.directory + ": can't be read: " + error.message());
  for (const std::string& name : more) run.sensors.push_back({.sensor = {.name = name}});
}

/// A number of a report that is null in its line where it was not measured.
std::optional<double> measured(const FrameReport& report, double value) {
  return report.detection_off ? std::nullopt : std::optional(value);
}

ReportFrame report_frame(const FrameReport& r, const std::string& middle_utc, std::size_t sensor) {
  ReportFrame f{.sensor = sensor,
                .number = r.frame,
                .middle = r.middle,
                .middle_utc = middle_utc,
                .boresight_ra_rad = r.boresight_ra_rad,
                .boresight_dec_rad = r.boresight_dec_rad,
                .sensor_position_m = r.sensor_position_m,
                .background_e = measured(r, r.background_e),
                .noise_e = measured(r, r.noise_e),
                .stars_found = r.stars_found,
                .stars_expected = r.stars_expected};
  if (r.limiting_magnitude != 0.0)
    f.limiting_magnitude = r.limiting_magnitude - r.magnitudes.solar_colour_mag;
  return f;
}

/// A line has the means over the `frames` up to its own.
void add_cost(const JsonRecord& line, ReportSensor& sensor, ReportFrame* frame) {
  const double total_s = line.number("total_s"), frames = line.get_or("frames", 1.0);
  sensor.seconds_per_frame += frames * total_s;
  sensor.memory_mb = std::max(sensor.memory_mb, line.get_or("pss_mb", 0.0));
  sensor.costs += std::size_t(frames);
  if (frame) frame->total_s = total_s;
  sensor.effects["detection"].measured_s += frames * line.get_or("detection_s", 0.0);
  if (line.has("effects_s"))
    for (const auto& [effect, seconds] : line.object("effects_s").all_numbers())
      sensor.effects[effect].measured_s += frames * seconds;
  if (!line.has("plan")) return;
  const JsonRecord plan = line.object("plan");
  if (frame) frame->predicted_s = optional_number(plan, "predicted_s");
  for (const auto& [effect, planned] : plan.object("effects").all_objects()) {
    EffectCost& cost = sensor.effects[effect];
    cost.levels[planned.get<std::string>("level")] += std::size_t(frames);
    if (cost.why.empty()) cost.why = planned.get_or<std::string>("why", "");
    if (!planned.has("predicted_s")) continue;
    cost.predicted_s += frames * planned.number("predicted_s");
    cost.planned_frames += std::size_t(frames);
  }
}

std::string key_of(const std::string& frame, const std::string& id) { return frame + "/" + id; }

/// What run.json would have said of a sensor, from its first frame.
void read_camera(const std::string& directory, RunSensor& sensor) {
  std::error_code ignored;
  std::vector<std::string> frames;
  for (const auto& entry : fs::directory_iterator(directory, ignored))
    if (entry.path().filename().string().starts_with("frame-") &&
        entry.path().extension() == ".fits")
      frames.push_back(entry.path().string());
  if (frames.empty()) return;
  try {
    const Frame frame = read_frame(*std::ranges::min_element(frames));
    sensor.columns = frame.counts.columns;
    sensor.rows = frame.counts.rows;
    sensor.camera = frame.header.observation.telescope;
    sensor.exposure_s = frame.header.exposure_s;
    if (const auto& site = frame.header.site)
      sensor.site = Site{site->latitude_rad / deg, site->longitude_rad / deg, site->height_m};
  } catch (const Error&) {
    // It may be of another kind, such as sources, or cut short: the sensor stays without a size.
  }
}

/// Reads the lines of one sensor; those of a frame without a report are left out.
void read_sensor(RunContents& run, std::size_t index, ScoreInput& input) {
  ReportSensor& sensor = run.sensors[index];
  const std::string& name = sensor.sensor.name;
  const std::string directory = run.directory + "/" + name;
  const auto lines_of = [&](const RunFile& file, const auto& take) {
    const std::string path = path_in(directory, file);
    const bool is_there = path_exists(path);
    if (is_there) for_lines(path, quietly, take);
    return is_there;
  };
  std::map<std::uint32_t, std::size_t> places;
  if (!path_exists(path_in(directory, run_file::frames))) return;
  if (sensor.sensor.columns == 0) read_camera(directory, sensor.sensor);
  lines_of(run_file::frames, [&](const JsonRecord& line) {
    FrameReport report = report_of(line);
    report.sensor = name;
    ReportFrame f = report_frame(report, line.get_or<std::string>("middle_utc", ""), index);
    for (const auto& [ending, member] :
         {std::pair(".fits", &ReportFrame::fits), std::pair(".png", &ReportFrame::picture),
          std::pair("-marked.png", &ReportFrame::marked)})
      if (const std::string file = name + "/" + frame_file_name(f.number, ending);
          path_exists(run.directory + "/" + file))
        f.*member = file;
    if (!places.emplace(f.number, run.frames.size()).second)
      line.fail("frame", "is there twice: " + std::to_string(f.number));
    input.frames.push_back(frame_of(report, sensor.sensor));
    run.frames.push_back(std::move(f));
    ++sensor.frames;
  });
  const auto place_of = [&](std::uint32_t frame) -> std::optional<std::size_t> {
    const auto found = places.find(frame);
    return found == places.end() ? std::nullopt : std::optional(found->second);
  };
  run.has_truth |= lines_of(run_file::truth, [&](const JsonRecord& line) {
    Truth truth = truth_of(line);
    const auto frame = place_of(truth.frame);
    if (!frame) return;
    truth.sensor = name;
    input.truths.push_back(source_of(truth));
    run.truths.push_back({*frame, std::move(truth)});
  });
  lines_of(run_file::detections, [&](const JsonRecord& line) {
    Detection d = detection_of(line);
    const auto frame = place_of(d.frame);
    if (!frame) return;
    d.sensor = name;
    ++sensor.detections;
    input.detections.push_back({.sensor = name, .frame = std::to_string(d.frame), .detection = d});
    run.detections.push_back({*frame, std::move(d)});
  });
  lines_of(run_file::costs, [&](const JsonRecord& line) {
    const auto frame = place_of(line.get<std::uint32_t>("frame"));
    add_cost(line, sensor, frame ? &run.frames[*frame] : nullptr);
  });
  if (sensor.costs > 0) sensor.seconds_per_frame /= double(sensor.costs);
  if (path_exists(run.directory + "/logs/" + name + ".log")) sensor.log = "logs/" + name + ".log";
}

/// Scores the run, and marks which truth was found and which detection is of a truth.
void judge(RunContents& run, ScoreInput input) {
  input.source = run.directory;
  input.status = run.record.status;
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

/// The path of what the fusion node has written, merged or in its own directory; empty: nothing.
std::string of_fusion(const std::string& directory, const RunFile& file) {
  for (const std::string& path :
       {path_in(directory, file), path_in(directory + "/fusion-node", file)})
    if (path_exists(path)) return path;
  return "";
}

void read_tracks(RunContents& run) {
  constexpr std::size_t max_points = 400;  // drawn for a track
  std::map<std::uint32_t, ReportTrack> tracks;
  if (const std::string path = of_fusion(run.directory, run_file::tracks); !path.empty())
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
  if (const std::string path = of_fusion(run.directory, run_file::tasks); !path.empty())
    for_lines(path, quietly, [&](const JsonRecord& line) {
      Task cue = task_of(line);
      if (const auto track = tracks.find(cue.track); track != tracks.end()) ++track->second.cues;
      run.cues.push_back(std::move(cue));
    });
  for (auto& [id, track] : tracks) {
    auto& points = track.sigma_m;
    if (const std::size_t every = (points.size() + max_points - 1) / max_points; every > 1) {
      std::size_t kept = 0;
      for (std::size_t k = 0; k < points.size(); k += every) points[kept++] = points[k];
      points.resize(kept);
    }
    run.tracks.push_back(std::move(track));
  }
}

void read_breakups(RunContents& run) {
  const std::string path = of_fusion(run.directory, run_file::breakups);
  if (path.empty()) return;
  for_lines(path, quietly, [&](const JsonRecord& line) {
    FoundBreakup breakup = found_breakup_of(line);
    const auto known = std::ranges::find(run.breakups, breakup.breakup, &FoundBreakup::breakup);
    (known == run.breakups.end() ? run.breakups.emplace_back() : *known) = std::move(breakup);
  });
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
                             before_s + tick.number("settled_s"),
                             tick.get_or<std::string>("last", "")});
    before_s += record.get_or("wall_s", 0.0);
  };
  const std::string logs = run.directory + "/logs/master";
  const auto of_part = [&](int part) { return logs + "-" + std::to_string(part) + ".json"; };
  for (int part = 1; path_exists(of_part(part)); ++part) read(of_part(part));
  if (path_exists(logs + ".json")) read(logs + ".json");
}

void find_files(RunContents& run) {
  for (const RunFile& file :
       {run_file::record, run_file::frames, run_file::detections, run_file::truth, run_file::tracks,
        run_file::orbits, run_file::breakups, run_file::tasks, run_file::positions_csv,
        run_file::positions})
    if (path_exists(path_in(run.directory, file))) run.files.push_back(file.name);
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
  if (auto record = read_run_record(directory)) run.record = std::move(*record);
  for (const RunSensor& sensor : run.record.sensors) run.sensors.push_back({.sensor = sensor});
  find_sensors(run);
  ScoreInput input;
  for (std::size_t k = 0; k < run.sensors.size(); ++k) read_sensor(run, k, input);
  if (run.sensors.empty())
    throw ConfigError(directory + ": no run: neither run.json nor a sensor with frames.jsonl");
  judge(run, std::move(input));
  read_tracks(run);
  read_breakups(run);
  read_ticks(run);
  find_files(run);
  return run;
}

}  // namespace dmise
