#include "launch/run_directory.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <tuple>

#include "core/base/digest.h"
#include "core/base/error.h"
#include "core/base/paths.h"
#include "core/base/text_file.h"
#include "core/base/whole_file.h"
#include "core/config/node_kinds.h"
#include "core/sky/star_map_file.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

/// What follows the first `"key":` of a JSON line written by JsonWriter; "0" if there is none.
const char* value_in(const std::string& line, const std::string& key) {
  const auto at = line.find("\"" + key + "\":");
  return at == std::string::npos ? "0" : line.c_str() + at + key.size() + 3;
}

double number_in(const std::string& line, const std::string& key) {
  return std::strtod(value_in(line, key), nullptr);
}

}  // namespace

std::vector<std::string> whole_lines(const std::string& path) {
  std::vector<std::string> lines;
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line))
    if (!file.eof()) lines.push_back(line);
  return lines;
}

std::string file_digest(const std::string& path) {
  return sha256_hex(is_star_map_file(path) ? star_map_fingerprint(path) : read_text_file(path));
}

std::string scenario_digest(const Scenario& scenario) {
  std::string all = physics_json(scenario);
  for (const auto& path : files_of(scenario.objects, scenario.own_objects))
    all += "\n" + (path.empty() ? std::string("none") : sha256_hex(read_text_file(path)));
  for (const auto& path : {scenario.star_catalogue_path, scenario.earth_orientation_path})
    all += "\n" + (path.empty() ? std::string("none") : file_digest(path));
  return sha256_hex(all).substr(0, 32);
}

RunDirectory::RunDirectory(std::string path, const Scenario& scenario, std::string digest)
    : path_(std::move(path)),
      scenario_(scenario),
      digest_(std::move(digest)),
      lock_(lock_directory(path_)) {
  for (const auto& source : scenario_.objects)
    catalogue_sha256_.push_back(sha256_hex(read_text_file(source.path)));
}

RunDirectory::Content RunDirectory::content() const {
  if (!path_exists(file("run.json"))) {
    for (const auto& sensor : scenario_.sensors)
      if (path_exists(file(sensor.name))) return Content::same_run_unfinished;
    return Content::empty;
  }
  const std::string text = read_text_file(file("run.json"));
  if (text.find("\"digest\":\"" + digest_ + "\"") == std::string::npos) return Content::another_run;
  return text.find("\"status\":\"complete\"") == std::string::npos ? Content::same_run_unfinished
                                                                   : Content::same_run_complete;
}

void RunDirectory::clear() {
  std::error_code ignored;
  // A subdirectory with a frames.jsonl is a sensor's, of this run or another.
  for (const auto& entry : fs::directory_iterator(path_, ignored))
    if (entry.is_directory(ignored) && path_exists(entry.path() / "frames.jsonl"))
      fs::remove_all(entry.path(), ignored);
  for (const auto& sensor : scenario_.sensors) fs::remove_all(file(sensor.name), ignored);
  for (const char* name :
       {"run.json", "detections.jsonl", "truth.jsonl", "frames.jsonl", "positions.csv",
        "positions.jsonl", "tracks.jsonl", "tasks.jsonl", "tracks.svg", "index.html"})
    fs::remove(file(name), ignored);
  fs::remove_all(file(fusion_node), ignored);
  for (const auto& entry : fs::directory_iterator(file("positions"), ignored))
    if (entry.path().extension() == ".oem") fs::remove(entry.path(), ignored);
  fs::remove(file("positions"), ignored);  // if it is empty
}

void RunDirectory::merge_lines() const {
  for (const std::string name : {"detections.jsonl", "truth.jsonl", "frames.jsonl"}) {
    if (name == "truth.jsonl" && !scenario_.output.truth) continue;
    // (time, sensor, index in the sensor's file): independent of the order of arrival.
    std::vector<std::tuple<std::int64_t, std::string, std::size_t, std::string>> rows;
    for (const auto& sensor : scenario_.sensors) {
      auto lines = whole_lines(file(sensor.name) + "/" + name);
      const char* time = name == "detections.jsonl" ? "time_ns" : "middle_ns";
      for (std::size_t i = 0; i < lines.size(); ++i)
        rows.emplace_back(std::strtoll(value_in(lines[i], time), nullptr, 10), sensor.name, i,
                          std::move(lines[i]));
    }
    std::sort(rows.begin(), rows.end());
    std::string text;
    for (const auto& row : rows) text += std::get<3>(row) + "\n";
    write_file_whole(file(name), text);
  }
}

long count_lines(const std::string& path) {
  std::ifstream file(path);
  return long(std::count(std::istreambuf_iterator<char>(file), {}, '\n'));
}

std::vector<SensorSummary> summarise(const Scenario& scenario, const std::string& run_path) {
  std::vector<SensorSummary> summaries;
  for (const auto& sensor : scenario.sensors) {
    SensorSummary s{.name = sensor.name};
    const std::string directory = run_path + "/" + sensor.name + "/";
    s.frames = int(count_lines(directory + "frames.jsonl"));
    s.detections = int(count_lines(directory + "detections.jsonl"));
    for (const auto& line : whole_lines(directory + "truth.jsonl"))
      s.objects += line.find("\"in_frame\":true") != std::string::npos;
    const auto costs = whole_lines(directory + "cost.jsonl");
    for (const auto& line : costs) {
      s.seconds_per_frame += number_in(line, "total_s") / double(costs.size());
      s.memory_mb = std::max(s.memory_mb, number_in(line, "pss_mb"));
    }
    summaries.push_back(s);
  }
  return summaries;
}

}  // namespace dmise
