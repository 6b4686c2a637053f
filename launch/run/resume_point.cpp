#include "launch/run/resume_point.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "core/base/files/json.h"
#include "core/base/files/paths.h"
#include "core/base/files/whole_file.h"
#include "core/base/printable.h"
#include "core/config/node_kinds.h"
#include "core/run/run_files.h"
#include "core/run/run_record.h"
#include "launch/run/node_makers.h"

namespace dmise {

namespace {

RunRecord record_of(const RunDirectory& directory) {
  existing_path(directory.path(), run_file::record);
  return *read_run_record(directory.path());
}

EarlierParts parts_of(const RunRecord& record) {
  return {.count = record.parts, .wall_s = record.wall_s.value_or(0.0)};
}

}  // namespace

EarlierParts parts_begun(const RunDirectory& directory) { return parts_of(record_of(directory)); }

EarlierParts earlier_parts(const Scenario& scenario, const RunDirectory& directory) {
  namespace fs = std::filesystem;
  const RunRecord record = record_of(directory);
  EarlierParts parts = parts_of(record);
  if (record.status != "begun") return parts;
  std::error_code error;
  const auto begun = fs::last_write_time(record.path, error);
  auto last = begun;
  for (const auto& sensor : scenario.sensors)
    if (const auto written = fs::last_write_time(
            path_in(directory.path() + "/" + sensor.name, run_file::frames), error);
        !error)
      last = std::max(last, written);
  parts.wall_s += std::chrono::duration<double>(last - begun).count();
  return parts;
}

void mark_begun(const RunDirectory& directory, const EarlierParts& earlier) {
  JsonWriter json;
  json.begin_object().field("status", "begun").field("digest", directory.digest());
  json.field("parts", earlier.count + 1).field("wall_s", earlier.wall_s).end_object();
  write_file_whole(path_in(directory.path(), run_file::record), json.take() + "\n");
}

void mark_failed(const RunDirectory& directory, const std::string& reason) {
  JsonWriter json;
  json.begin_object().field("status", "failed").field("digest", directory.digest());
  json.field("reason", printable(reason, 400)).end_object();
  const std::string text = json.take() + "\n";
  const int file =
      open(path_in(directory.path(), run_file::record).c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return;
  if (write(file, text.data(), text.size()) == ssize_t(text.size())) [[maybe_unused]]
    const int shortened = ftruncate(file, off_t(text.size()));
  close(file);
}

Tick resume_tick(const Scenario& scenario, const RunDirectory& directory) {
  // Without it the frames cannot be attributed to a run.
  if (!path_exists(path_in(directory.path(), run_file::record))) return 0;
  std::uint32_t finished = 0;
  for (const auto& sensor : scenario.sensors)
    finished += frames_finished(sensor.name, directory.path());
  if (finished == 0) return 0;
  Tick first = scenario.last_tick();
  for (const NodeKind& kind : node_kinds())
    for (const auto& node : nodes_of(kind, scenario))
      if (const auto tick = maker_of(kind).unfinished(node, scenario, directory.path()))
        first = std::min(first, *tick);
  return first;
}

}  // namespace dmise
