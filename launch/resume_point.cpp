#include "launch/resume_point.h"

#include <algorithm>

#include "core/base/json.h"
#include "core/base/paths.h"
#include "core/base/whole_file.h"
#include "core/config/node_kinds.h"
#include "launch/node_makers.h"

namespace dmise {

void mark_begun(const RunDirectory& directory) {
  JsonWriter json;
  json.begin_object().field("status", "begun").field("digest", directory.digest()).end_object();
  write_file_whole(directory.path() + "/run.json", json.take() + "\n");
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
