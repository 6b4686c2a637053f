#include "launch/run_directory.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <tuple>

#include "core/base/digest.h"
#include "core/base/error.h"
#include "core/base/paths.h"
#include "core/base/text_file.h"
#include "core/base/whole_file.h"
#include "core/config/node_kinds.h"
#include "launch/file_digest.h"

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

/// run.json while products of an earlier run are removed.
constexpr const char* clearing = "{\"status\":\"clearing\"}\n";

/// Products of a run, beside those in the directories of its nodes and run.json.
constexpr const char* run_files[] = {"detections.jsonl", "truth.jsonl",     "frames.jsonl",
                                     "positions.csv",    "positions.jsonl", "tracks.jsonl",
                                     "tasks.jsonl",      "tracks.svg",      "index.html"};

/// Of files that ProductWriter and CueJournal write.
bool is_product_of_sensor(const std::string& file) {
  constexpr std::string_view partial = ".partial", frame = "frame-", digits = "0123456789";
  constexpr std::string_view tables[] = {"frames.jsonl", "detections.jsonl", "truth.jsonl",
                                         "cost.jsonl", "tasks.journal"};
  constexpr std::string_view endings[] = {".fits",       "-sources.fits", "-background.fits",
                                          "-noise.fits", "-radiance.exr", ".png",
                                          "-marked.png", ".stars.csv"};
  std::string_view name = file;
  if (name.ends_with(partial)) name.remove_suffix(partial.size());
  if (std::ranges::find(tables, name) != std::end(tables)) return true;
  const auto end = name.find_first_not_of(digits, frame.size());
  return name.starts_with(frame) && end != name.npos && end > frame.size() &&
         std::ranges::find(endings, name.substr(end)) != std::end(endings);
}

std::vector<std::string> nodes_with_journals(const Scenario& scenario) {
  std::vector<std::string> nodes{fusion_node};
  for (const auto& node : scenario.own_nodes)
    if (!node.consumes.empty()) nodes.push_back(node.name);
  return nodes;
}

/// NAME-NUMBER.oem.
bool is_ephemeris(const std::string& name) {
  constexpr std::string_view ending = ".oem";
  if (!name.ends_with(ending) || name.size() == ending.size()) return false;
  const auto dash = name.find_last_not_of("0123456789", name.size() - ending.size() - 1);
  return dash != name.npos && name[dash] == '-' && dash + 1 < name.size() - ending.size();
}

/// Whether the lines in a directory's frames.jsonl are those of a sensor of its name.
bool is_sensor_directory(const fs::path& directory) {
  std::ifstream file(directory / "frames.jsonl");
  std::string line;
  return std::getline(file, line) &&
         line.starts_with("{\"sensor\":\"" + directory.filename().string() + "\",\"frame\":");
}

/// Removes the products in a directory that is not one of a run, then the directory if it is empty
/// and not a link.
void remove_products(const fs::path& directory, bool (*is_product)(const std::string& name)) {
  std::error_code ignored;
  if (path_exists(directory / "run.json")) return;  // of a run there
  std::vector<fs::path> products;
  for (const auto& entry : fs::directory_iterator(directory, ignored))
    if (is_product(entry.path().filename().string())) products.push_back(entry.path());
  for (const auto& product : products) remove_file(product.string());
  if (!fs::is_symlink(directory, ignored)) fs::remove(directory, ignored);
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

std::string scenario_digest(const Scenario& scenario) {
  std::string all = physics_json(scenario);
  for (const auto& path : files_of(scenario.objects, scenario.own_objects))
    all += "\n" + (path.empty() ? std::string("none") : file_digest(path));
  for (const auto& path : files_of(scenario.own_nodes))
    all += "\n" + sha256_hex(read_text_file(path));
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
  if (!path_exists(file("run.json"))) return Content::no_run;
  const std::string text = read_text_file(file("run.json"));
  if (text == clearing) return Content::half_cleared;
  if (text.find("\"digest\":\"" + digest_ + "\"") == std::string::npos) return Content::another_run;
  return text.find("\"status\":\"complete\"") == std::string::npos ? Content::same_run_unfinished
                                                                   : Content::same_run_complete;
}

std::string RunDirectory::in_the_way() const {
  std::error_code ignored;
  for (const char* name : run_files)
    if (fs::exists(fs::symlink_status(file(name), ignored))) return file(name);
  std::vector<std::string> directories = nodes_with_journals(scenario_);
  for (const auto& sensor : scenario_.sensors) directories.push_back(sensor.name);
  if (scenario_.output.positions_oem) directories.push_back("positions");
  for (const auto& name : directories) {
    const bool is_empty =
        fs::is_directory(file(name), ignored) && fs::is_empty(file(name), ignored);
    if (!is_empty && fs::exists(fs::symlink_status(file(name), ignored))) return file(name);
  }
  return "";
}

void RunDirectory::check_sensor_directories() const {
  for (const auto& sensor : scenario_.sensors)
    if (path_exists(file(sensor.name) + "/run.json"))
      throw ConfigError(file(sensor.name) + ": is the directory of a run, sensor " + sensor.name +
                        " can't write there; --out writes elsewhere");
}

bool RunDirectory::lacks_nodes() const {
  return path_exists(file("run.json")) &&
         read_text_file(file("run.json")).find("\"dropped\":[\"") != std::string::npos;
}

void RunDirectory::clear(bool others) {
  write_file_whole(file("run.json"), clearing);
  for (const char* name : run_files) remove_file(file(name));
  std::error_code ignored;
  std::vector<fs::path> sensors;
  if (others)
    for (const auto& entry : fs::directory_iterator(path_, ignored))
      if (!entry.is_symlink(ignored) && is_sensor_directory(entry.path()))
        sensors.push_back(entry.path());
  for (const auto& sensor : scenario_.sensors) sensors.emplace_back(file(sensor.name));
  for (const auto& sensor : sensors) remove_products(sensor, is_product_of_sensor);
  for (const auto& node : nodes_with_journals(scenario_))
    remove_products(file(node), [](const std::string& name) {
      return name == "inputs.journal" || name == "tracks.jsonl" || name == "tasks.jsonl";
    });
  if (others || scenario_.output.positions_oem) remove_products(file("positions"), is_ephemeris);
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
    double frames = 0.0, seconds = 0.0;
    for (const auto& line : whole_lines(directory + "cost.jsonl")) {
      const double of_line = std::max(1.0, number_in(line, "frames"));
      frames += of_line;
      seconds += of_line * number_in(line, "total_s");
      s.memory_mb = std::max(s.memory_mb, number_in(line, "pss_mb"));
    }
    if (frames > 0.0) s.seconds_per_frame = seconds / frames;
    summaries.push_back(s);
  }
  return summaries;
}

}  // namespace dmise
