#include "core/config/own_node_roles.h"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/printable.h"
#include "core/config/node_kinds.h"
#include "core/config/scenario.h"

namespace dmise {
namespace {

/// Returns the node of the user's of this name, which has the role from then on. Throws
/// `ConfigError` at `where` if there is none, or one that has another.
OwnNode& give_role(Scenario& scenario, const std::string& name, const std::string& where,
                   OwnNodeRole role) {
  std::vector<std::string> names;
  for (const OwnNode& node : scenario.own_nodes) names.push_back(node.name);
  const auto node = std::ranges::find(scenario.own_nodes, name, &OwnNode::name);
  if (node == scenario.own_nodes.end())
    throw ConfigError(where + ": no node of `nodes` has this name" + did_you_mean(name, names) +
                      ", got " + printable(name));
  constexpr const char* does[] = {"", "moves or turns objects", "detects", "tracks", "observes"};
  if (node->role != OwnNodeRole::none && node->role != role)
    throw ConfigError(node->where + ": " + does[int(node->role)] + " and " + does[int(role)] +
                      ": give each a node");
  node->role = role;
  return *node;
}

/// Gives a role to a node that `who`, the process of a sensor or of the fusion node, starts.
void give_inner_role(Scenario& scenario, const std::string& name, const std::string& where,
                     OwnNodeRole role, const std::string& who, const std::string& asked) {
  const OwnNode& node = give_role(scenario, name, where, role);
  if (node.is_fmu)
    throw ConfigError(where + ": an FMU moves or turns an object, and " + name + " is one");
  if (node.run.empty() && !node.is_function)
    throw ConfigError(where + ": its node is elsewhere, but " + who + ": " + name + " needs run");
  if (node.period_ticks != 1)
    throw ConfigError(node.where + ".period_ticks: a " + asked + ": must be 1, got " +
                      std::to_string(node.period_ticks));
}

/// Topics of the run that a node of the user's may hear.
std::vector<std::string> topics_to_hear(const Scenario& scenario, const OwnNode& node) {
  std::vector<std::string> topics;
  for (const SensorConfig& sensor : scenario.sensors) {
    topics.push_back("frame/" + sensor.name);
    if (sensor.detect) topics.push_back("detection/" + sensor.name);
    if (std::holds_alternative<PointCued>(sensor.pointing)) topics.push_back("task/" + sensor.name);
  }
  if (scenario.fusion) topics.push_back(std::string("track/") + fusion_node);
  for (const OwnNode& other : scenario.own_nodes)
    if (other.role == OwnNodeRole::actor && other.name != node.name)
      topics.push_back("state/actor/" + other.name);
  return topics;
}

bool is_heard(const std::string& pattern, const std::string& topic) {
  return pattern.ends_with("/*") ? topic.starts_with(pattern.substr(0, pattern.size() - 1))
                                 : topic == pattern;
}

/// Finds the topics that a node of the user's consumes. Throws `ConfigError` for one that nobody
/// publishes.
void find_topics(const Scenario& scenario, OwnNode& node) {
  if (!node.hears.empty() && node.role != OwnNodeRole::actor)
    throw ConfigError(node.hears.front().where + ": only a node that moves or turns objects " +
                      "consumes topics");
  const std::vector<std::string> topics = topics_to_hear(scenario, node);
  std::set<std::string> found;
  for (const HeardTopics& hears : node.hears) {
    const auto is_of = [&](const std::string& topic) { return is_heard(hears.pattern, topic); };
    if (std::ranges::none_of(topics, is_of))
      throw ConfigError(hears.where + ": nobody publishes it" +
                        did_you_mean(hears.pattern, topics) + ", got " + printable(hears.pattern));
    std::ranges::copy_if(topics, std::inserter(found, found.end()), is_of);
  }
  node.consumes.assign(found.begin(), found.end());
}

/// Throws `ConfigError` for an FMU that does not say what an object needs of it.
void require_outputs(const OwnNode& node, std::initializer_list<const char*> outputs,
                     const char* does) {
  for (const char* output : outputs)
    if (node.is_fmu && std::ranges::count(node.fmu_outputs, output) == 0)
      throw ConfigError(node.fmu_outputs_where + ": lacks " + output + ", which an FMU that " +
                        does + " an object must say");
}

}  // namespace

bool is_moved_by(const OwnNode& node, const OwnObject& object) {
  const NodeMotion* motion = motion_by_node(object);
  return motion && motion->node == node.name;
}

bool is_turned_by(const OwnNode& node, const OwnObject& object) {
  const NodeAttitude* attitude = attitude_by_node(object);
  return attitude && attitude->node == node.name;
}

void assign_own_nodes(Scenario& scenario) {
  std::map<std::string, std::size_t> counts;
  for (OwnObject& object : scenario.own_objects) {
    auto* model = std::get_if<MotionModel>(&object.motion.model);
    auto* motion = model ? std::get_if<NodeMotion>(model) : nullptr;
    auto* attitude = object.attitude ? std::get_if<NodeAttitude>(&object.attitude->model) : nullptr;
    if (motion) {
      require_outputs(
          give_role(scenario, motion->node, object.motion.node_where, OwnNodeRole::actor),
          {"position_m", "velocity_m_per_s"}, "moves");
      motion->place = counts[motion->node]++;
    }
    if (!attitude) continue;
    require_outputs(
        give_role(scenario, attitude->node, object.attitude->node_where, OwnNodeRole::actor),
        {"gcrs_from_body"}, "turns");
    const bool both = motion && motion->node == attitude->node;
    attitude->place = both ? motion->place : counts[attitude->node]++;
  }
  for (const SensorConfig& sensor : scenario.sensors) {
    if (const auto& detector = sensor.detector)
      give_inner_role(scenario, detector->node, detector->where, OwnNodeRole::detector,
                      "a sensor starts its detector", "detector is asked for each frame");
    if (const auto& observing = sensor.observing)
      give_inner_role(scenario, observing->node, observing->where, OwnNodeRole::sensor,
                      "a sensor starts its program", "sensor is asked at each exposure");
  }
  if (const auto& fusion = scenario.fusion; fusion && !fusion->node.empty())
    give_inner_role(scenario, fusion->node, fusion->node_where, OwnNodeRole::tracker,
                    "the fusion node starts its tracker", "tracker is asked at each tick");
  for (const OwnNode& node : scenario.own_nodes) {
    if (node.is_fmu && counts[node.name] > 1)
      throw ConfigError(node.where + ": an FMU moves or turns one object, got " +
                        std::to_string(counts[node.name]));
    if (node.role == OwnNodeRole::none)
      throw ConfigError(node.where + ": moves and turns no object (motion: {node: " + node.name +
                        "}), no sensor detects by it (detection: {node: " + node.name +
                        "}) or is it (node: " + node.name +
                        "), and it makes no tracks (fusion: {node: " + node.name + "})");
  }
  for (OwnNode& node : scenario.own_nodes) find_topics(scenario, node);
}

}  // namespace dmise
