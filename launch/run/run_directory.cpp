#include "launch/run/run_directory.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <tuple>

#include "core/base/error.h"
#include "core/base/files/digest.h"
#include "core/base/files/json.h"
#include "core/base/files/json_record.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/config/node_kinds.h"
#include "core/run/run_files.h"
#include "core/run/run_record.h"
#include "launch/run/file_digest.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

/// Status in run.json while products of an earlier run are removed.
constexpr const char* clearing = "clearing";

std::vector<std::string> nodes_with_journals(const Scenario& scenario) {
  std::vector<std::string> nodes{fusion_node};
  for (const auto& node : scenario.own_nodes)
    if (!node.consumes.empty()) nodes.push_back(node.name);
  return nodes;
}

/// NAME-NUMBER.oem.
bool is_ephemeris(std::string_view name) {
  constexpr std::string_view ending = ".oem";
  if (!name.ends_with(ending) || name.size() == ending.size()) return false;
  const auto dash = name.find_last_not_of("0123456789", name.size() - ending.size() - 1);
  return dash != name.npos && name[dash] == '-' && dash + 1 < name.size() - ending.size();
}

/// Whether the lines in a directory's frames.jsonl are those of a sensor of its name.
bool is_sensor_directory(const fs::path& directory) {
  std::ifstream file(path_in(directory.string(), run_file::frames));
  std::string line;
  return std::getline(file, line) &&
         line.starts_with("{\"sensor\":\"" + directory.filename().string() + "\",\"frame\":");
}

/// Removes the products in a directory that is not one of a run, then the directory if it is empty
/// and not a link.
void remove_products(const fs::path& directory, bool (*is_product)(std::string_view name)) {
  std::error_code ignored;
  if (path_exists(path_in(directory.string(), run_file::record))) return;  // a run is there
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
  if (scenario.fusion && !scenario.fusion->catalogue_path.empty())
    all += "\n" + file_digest(scenario.fusion->catalogue_path);
  for (const auto& path : {scenario.star_catalogue_path, scenario.earth_orientation_path})
    all += "\n" + (path.empty() ? std::string("none") : file_digest(path));
  if (!scenario.star_variables_path.empty())
    all += "\n" + file_digest(scenario.star_variables_path);
  return sha256_hex(all).substr(0, 32);
}

RunDirectory::RunDirectory(std::string path, const Scenario& scenario, std::string digest)
    : path_(std::move(path)),
      scenario_(scenario),
      digest_(std::move(digest)),
      lock_(lock_directory(path_)) {
  for (const auto& source : scenario_.objects)
    if (!source.path.empty()) catalogue_sha256_.push_back(sha256_hex(read_text_file(source.path)));
}

RunDirectory::Content RunDirectory::content() const {
  try {
    const auto record = read_run_record(path_);
    if (!record) return Content::no_run;
    if (record->status == clearing) return Content::half_cleared;
    if (record->digest != digest_) return Content::another_run;
    return record->status == "complete" ? Content::same_run_complete : Content::same_run_unfinished;
  } catch (const ConfigError&) {
    return Content::unreadable;
  }
}

std::string RunDirectory::in_the_way() const {
  std::error_code ignored;
  for (const RunFile& product : run_file::products)
    if (fs::exists(fs::symlink_status(file(product.name), ignored))) return file(product.name);
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
    if (path_exists(path_in(file(sensor.name), run_file::record)))
      throw ConfigError(file(sensor.name) + ": is the directory of a run, sensor " + sensor.name +
                        " can't write there; --out writes elsewhere");
}

bool RunDirectory::lacks_nodes() const {
  const auto record = read_run_record(path_);
  return record && !record->dropped.empty();
}

void RunDirectory::clear(bool others) {
  JsonWriter mark;
  mark.begin_object().field("status", clearing).end_object();
  write_file_whole(path_in(path_, run_file::record), mark.take() + "\n");
  for (const RunFile& product : run_file::products) remove_file(file(product.name));
  std::error_code ignored;
  std::vector<fs::path> sensors;
  if (others)
    for (const auto& entry : fs::directory_iterator(path_, ignored))
      if (!entry.is_symlink(ignored) && is_sensor_directory(entry.path()))
        sensors.push_back(entry.path());
  for (const auto& sensor : scenario_.sensors) sensors.emplace_back(file(sensor.name));
  for (const auto& sensor : sensors) remove_products(sensor, is_file_of_sensor);
  for (const auto& node : nodes_with_journals(scenario_))
    remove_products(file(node), [](std::string_view name) {
      return name == "inputs.journal" || name == run_file::tracks.name ||
             name == run_file::tasks.name || name == run_file::orbits.name ||
             name == run_file::breakups.name;
    });
  if (others || scenario_.output.positions_oem) remove_products(file("positions"), is_ephemeris);
}

void RunDirectory::merge_lines() const {
  for (const RunFile& table : run_file::merged) {
    const std::string name = table.name;
    if (name == run_file::truth.name && !scenario_.output.truth) continue;
    // (time, sensor, order in the sensor's file): independent of the order of arrival.
    std::vector<std::tuple<std::int64_t, std::string, std::size_t, std::string>> rows;
    for (const auto& sensor : scenario_.sensors) {
      const std::string path = path_in(file(sensor.name), table);
      if (!path_exists(path)) continue;
      const char* time = name == run_file::detections.name ? "time_ns" : "middle_ns";
      for_line_texts(path, quietly, [&](const std::string& line, const std::string& place) {
        rows.emplace_back(JsonRecord(line, place).get<std::int64_t>(time), sensor.name, rows.size(),
                          line);
      });
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
    const std::string directory = run_path + "/" + sensor.name;
    s.frames = int(count_lines(path_in(directory, run_file::frames)));
    s.detections = int(count_lines(path_in(directory, run_file::detections)));
    const auto for_lines_of = [&](const RunFile& table, auto&& take) {
      if (const auto path = path_in(directory, table); path_exists(path))
        for_lines(path, quietly, take);
    };
    for_lines_of(run_file::truth,
                 [&](const JsonRecord& line) { s.objects += line.get_or("in_frame", false); });
    double frames = 0.0, seconds = 0.0;
    for_lines_of(run_file::costs, [&](const JsonRecord& line) {
      const double of_line = std::max(1.0, line.get_or("frames", 1.0));
      frames += of_line;
      seconds += of_line * line.get_or("total_s", 0.0);
      s.memory_mb = std::max(s.memory_mb, line.get_or("pss_mb", 0.0));
    });
    if (frames > 0.0) s.seconds_per_frame = seconds / frames;
    summaries.push_back(s);
  }
  return summaries;
}

}  // namespace dmise
