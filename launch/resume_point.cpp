#include "launch/resume_point.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "core/base/json.h"
#include "core/base/paths.h"
#include "core/base/printable.h"
#include "core/base/text_file.h"
#include "core/base/whole_file.h"
#include "core/config/node_kinds.h"
#include "core/score/json_record.h"
#include "launch/node_makers.h"

namespace dmise {

namespace {

EarlierParts parts_in(const JsonRecord& record) {
  return {.count = record.has("parts") ? record.get<int>("parts") : 1,
          .wall_s = record.has("wall_s") ? record.number("wall_s") : 0.0};
}

}  // namespace

EarlierParts parts_begun(const RunDirectory& directory) {
  const std::string path = directory.path() + "/run.json";
  return parts_in(JsonRecord(read_text_file(path), path));
}

EarlierParts earlier_parts(const Scenario& scenario, const RunDirectory& directory) {
  namespace fs = std::filesystem;
  const std::string path = directory.path() + "/run.json";
  const JsonRecord record(read_text_file(path), path);
  EarlierParts parts = parts_in(record);
  if (record.get<std::string>("status") != "begun") return parts;
  std::error_code error;
  const auto begun = fs::last_write_time(path, error);
  auto last = begun;
  for (const auto& sensor : scenario.sensors)
    if (const auto written =
            fs::last_write_time(directory.path() + "/" + sensor.name + "/frames.jsonl", error);
        !error)
      last = std::max(last, written);
  parts.wall_s += std::chrono::duration<double>(last - begun).count();
  return parts;
}

void mark_begun(const RunDirectory& directory, const EarlierParts& earlier) {
  JsonWriter json;
  json.begin_object().field("status", "begun").field("digest", directory.digest());
  json.field("parts", earlier.count + 1).field("wall_s", earlier.wall_s).end_object();
  write_file_whole(directory.path() + "/run.json", json.take() + "\n");
}

void mark_failed(const RunDirectory& directory, const std::string& reason) {
  JsonWriter json;
  json.begin_object().field("status", "failed").field("digest", directory.digest());
  json.field("reason", printable(reason, 400)).end_object();
  const std::string text = json.take() + "\n";
  const int file =
      open((directory.path() + "/run.json").c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return;
  if (write(file, text.data(), text.size()) == ssize_t(text.size())) [[maybe_unused]]
    const int shortened = ftruncate(file, off_t(text.size()));
  close(file);
}

Tick resume_tick(const Scenario& scenario, const RunDirectory& directory) {
  // Without it the frames cannot be attributed to a run.
  if (!path_exists(directory.path() + "/run.json")) return 0;
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
