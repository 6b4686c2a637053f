#include "launch/run/replayed_nodes.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "launch/run/make_fusion.h"
#include "nodes/own/recorded_actor.h"
#include "nodes/own/recorded_sensor.h"
#include "sensors/scene/frame_times.h"

namespace dmise {

std::map<std::string, std::string> recordings_of(const std::vector<std::string>& replayed,
                                                 const Scenario& scenario) {
  std::map<std::string, std::string> recordings;
  for (const std::string& one : replayed) {
    const std::string name = one.substr(0, one.find('='));
    const auto node = std::ranges::find(scenario.own_nodes, name, &OwnNode::name);
    if (name == one || node == scenario.own_nodes.end())
      throw ConfigError("--replay-node: must be NODE=FILE with a node of `nodes`, got " +
                        printable(one));
    recordings[name] = one.substr(name.size() + 1);
  }
  return recordings;
}

namespace {

/// A sensor that is cued makes some of these frames only.
std::uint32_t frames_due(const SensorConfig& sensor, const Scenario& scenario) {
  const bool cued = std::holds_alternative<PointCued>(sensor.pointing);
  return cued ? 0 : std::uint32_t(frames_within(sensor, scenario.duration));
}

}  // namespace

ReplayedNodes replayed_nodes(const std::map<std::string, std::string>& recordings,
                             const Scenario& scenario, const std::string& digest) {
  ReplayedNodes nodes;
  for (const auto& [name, path] : recordings) {
    const OwnNode& node = *std::ranges::find(scenario.own_nodes, name, &OwnNode::name);
    if (node.role == OwnNodeRole::actor)
      nodes.actors[name] = std::make_unique<RecordedActor>(scenario, name, digest, path);
    if (node.role == OwnNodeRole::tracker)
      nodes.tracker = make_recorded_tracker(scenario, digest, path);
    for (const SensorConfig& sensor : scenario.sensors) {
      const RecordedSensor recorded{scenario, sensor.name, frames_due(sensor, scenario), digest,
                                    path};
      if (sensor.detector && sensor.detector->node == name)
        nodes.finders[sensor.name] = recorded_finder(recorded);
      if (sensor.observing && sensor.observing->node == name)
        nodes.observers[sensor.name] = recorded_observer(recorded);
    }
  }
  return nodes;
}

}  // namespace dmise
