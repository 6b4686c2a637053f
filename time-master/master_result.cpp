#include "time-master/master_result.h"

#include <spdlog/fmt/fmt.h>

#include "core/base/files/json.h"
#include "nodes/runtime/process/seconds.h"

namespace dmise {

MasterResult result_of(const Coordinator& coordinator) {
  MasterResult result;
  result.reason = coordinator.cause();
  result.ended = coordinator.phase() == Phase::ended;
  result.exit_code = result.ended && result.reason.empty() ? 0 : 1;
  result.digest = coordinator.digest();
  result.overruns = coordinator.pace().overruns();
  result.worst_lag_s = to_seconds(coordinator.pace().worst_lag());
  result.granted = coordinator.granted();
  for (const auto* members : {&coordinator.members(), &coordinator.behind()})
    for (const auto& [name, member] : *members) {
      if (member.dropped) result.dropped.push_back(name);
      if (member.incarnation > 1) result.restarts[name] = int(member.incarnation) - 1;
    }
  return result;
}

std::string to_json(const MasterResult& result) {
  JsonWriter json;
  json.begin_object();
  json.field("status", result.ended ? "ended" : "failed");
  json.field("cause", result.reason);
  json.field("granted_tick", std::int64_t(result.granted));
  json.field("wall_s", result.wall_s);
  json.field("cpu_s", result.cpu_s).field("messages", result.messages);
  json.field("digest", fmt::format("{:016x}", result.digest));
  json.field("overruns", result.overruns).field("worst_lag_s", result.worst_lag_s);
  json.list("dropped", result.dropped);
  json.key("restarts").begin_object();
  for (const auto& [name, count] : result.restarts) json.field(name, std::int64_t(count));
  json.end_object();
  json.key("nodes").begin_object();
  for (const auto& [name, times] : result.times) {
    json.key(name).begin_object();
    json.field("compute_s", times.compute_s);
    json.field("messaging_s", times.messaging_s);
    json.field("waiting_s", times.waiting_s);
    json.end_object();
  }
  json.end_object().key("waited_for_s").begin_object();
  for (const auto& [name, seconds] : result.waited_for_s) json.field(name, seconds);
  json.end_object().key("ticks").begin_array();
  for (const TickRecord& t : result.ticks) {
    json.begin_object().field("tick", std::int64_t(t.tick)).field("granted_s", t.granted_s);
    json.field("settled_s", t.settled_s).field("last", t.last).end_object();
  }
  json.end_array().end_object();
  return json.take();
}

}  // namespace dmise
