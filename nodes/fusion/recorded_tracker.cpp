#include "nodes/fusion/recorded_tracker.h"

#include <algorithm>
#include <set>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/config/node_kinds.h"
#include "nodes/own/recorded_run.h"

namespace dmise {

RecordedTracker::RecordedTracker(const Scenario& scenario, const std::string& digest,
                                 const std::string& path) {
  const Tick last = scenario.last_tick();
  std::map<std::string, Tick> complete_to{{std::string(track_prefix) + fusion_node, -1}};
  for (const SensorConfig& sensor : scenario.sensors)
    if (std::holds_alternative<PointCued>(sensor.pointing))
      complete_to[task_prefix + sensor.name] = -1;
  std::set<std::string> topics;
  for (const auto& [topic, tick] : complete_to) topics.insert(topic);
  const auto hear = [&](const RecordedState& recorded) {
    Tick& complete = complete_to[recorded.topic];
    complete = std::max(complete, recorded.complete_to);
    if (recorded.state) add(recorded.state);
    return std::ranges::any_of(complete_to, [&](const auto& of) { return of.second < last; });
  };
  read_recorded_run(scenario, digest, path, topics, hear, [&] {
    for (const auto& [topic, tick] : complete_to)
      if (tick < last)
        throw ConfigError("has " + topic + " up to tick " + std::to_string(tick) +
                          ", the run has " + std::to_string(last));
    if (Tick(tracks_.size()) <= last)
      throw ConfigError("lacks tracks of tick " + std::to_string(tracks_.size()));
  });
}

void RecordedTracker::add(std::shared_ptr<const State> state) {
  if (const auto* tasks = std::get_if<TaskSet>(state.get())) {
    for (const Task& task : tasks->tasks) tasks_[tasks->tick].emplace(task.id, task);
    return;
  }
  const auto* tracks = std::get_if<TrackSet>(state.get());
  if (!tracks) throw ConfigError("has something else than tracks and tasks of the fusion node");
  const Tick due = Tick(tracks_.size());
  if (tracks->tick > due) throw ConfigError("lacks tracks of tick " + std::to_string(due));
  if (tracks->tick == due) tracks_.push_back(std::move(state));  // else said again
}

std::optional<Tracker::Tracked> RecordedTracker::step(Tick tick, std::span<const SearchedFrame>) {
  const auto& set = std::get<TrackSet>(*tracks_.at(std::size_t(tick)));
  Tracked out;
  out.tracks.tracks = set.tracks;
  out.tracks.live = set.live;
  out.tracks.unassociated = set.unassociated;
  out.tasks.emplace();
  if (const auto given = tasks_.find(tick); given != tasks_.end())
    for (const auto& [id, task] : given->second) out.tasks->push_back(task);
  return out;
}

}  // namespace dmise
