#include "launch/resume_point.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/base/json.h"
#include "core/base/whole_file.h"
#include "sensors/pipeline/frame_times.h"
#include "sensors/positions/position_files.h"

namespace dmise {
namespace {

/// Frames from the first on whose line is whole: it is written last of all.
std::uint32_t frames_finished(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::uint32_t frames = 0;
  while (std::getline(file, line) && !file.eof()) ++frames;
  return frames;
}

}  // namespace

void mark_begun(const RunDirectory& directory) {
  JsonWriter json;
  json.begin_object().field("status", "begun").field("digest", directory.digest()).end_object();
  write_file_whole(directory.path() + "/run.json", json.take() + "\n");
}

Tick resume_tick(const Scenario& scenario, const RunDirectory& directory) {
  std::error_code ignored;
  // Without it nothing tells which run the frames are of.
  if (!std::filesystem::exists(directory.path() + "/run.json", ignored)) return 0;
  Tick first = scenario.last_tick();
  std::uint32_t finished = 0;
  for (const auto& sensor : scenario.sensors) {
    const std::uint32_t frames =
        frames_finished(directory.path() + "/" + sensor.name + "/frames.jsonl");
    finished += frames;
    if (frames >= frames_within(sensor, scenario.duration)) continue;
    const SimTime end = frame_times(sensor, frames + 1).end;
    first = std::min(first,
                     tick_needed(scenario.interpolation, end, scenario.tick, scenario.last_tick()));
  }
  // What is written of the last tick may be a part of it.
  if (scenario.output.positions())
    first = std::min(first, std::max<Tick>(0, last_tick_written(directory.path())));
  return finished == 0 ? 0 : first;
}

}  // namespace dmise
