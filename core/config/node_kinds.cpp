#include "core/config/node_kinds.h"

#include <algorithm>

namespace dmise {
namespace {

bool always(const Scenario&) { return true; }

bool is_actor(const OwnNode& node) { return node.role == OwnNodeRole::actor; }

const std::vector<NodeKind> table{
    {.name = orbit_node,
     .program = "dmise-orbit-node",
     .topics = {"state/roster", "state/objects"},
     .wanted = always},
    {.name = environment_node,
     .program = "dmise-environment-node",
     .topics = {"env/common", "env/site/"},
     .wanted = always},
    {.name = any_own_node,
     .program = "dmise-own-node",
     .topics = {"state/actor/"},
     .wanted = [](const Scenario& s) { return std::ranges::any_of(s.own_nodes, is_actor); },
     .each_own_node = true},
    {.name = any_sensor,
     .program = "dmise-sensor-node",
     .topics = {"frame/", "detection/", "truth/"},
     .wanted = always,
     .writes_products = true,
     .each_sensor = true},
    {.name = positions_node,
     .program = "dmise-positions-node",
     .topics = {},
     .wanted = [](const Scenario& s) { return s.output.positions(); },
     .writes_products = true},
    {.name = fusion_node,
     .program = "dmise-fusion-node",
     .topics = {"track/fusion-node", "task/"},
     .wanted = [](const Scenario& s) { return s.fusion.has_value(); },
     .writes_products = true},
};

bool is_sensor(const std::string& name, const Scenario& scenario) {
  return std::ranges::any_of(scenario.sensors, [&](const auto& s) { return s.name == name; });
}

bool is_own_node(const std::string& name, const Scenario& scenario) {
  return std::ranges::any_of(scenario.own_nodes,
                             [&](const auto& n) { return n.name == name && is_actor(n); });
}

bool is_of(const NodeKind& kind, const std::string& name, const Scenario& scenario) {
  if (kind.each_sensor) return is_sensor(name, scenario);
  return kind.each_own_node ? is_own_node(name, scenario) : name == kind.name;
}

}  // namespace

std::span<const NodeKind> node_kinds() { return table; }

const NodeKind* kind_of_node(const std::string& name, const Scenario& scenario) {
  for (const NodeKind& kind : table)
    if (is_of(kind, name, scenario)) return &kind;
  return nullptr;
}

std::vector<std::string> nodes_of(const NodeKind& kind, const Scenario& scenario) {
  if (!kind.wanted(scenario)) return {};
  if (!kind.each_sensor && !kind.each_own_node) return {kind.name};
  std::vector<std::string> names;
  if (kind.each_sensor)
    for (const auto& sensor : scenario.sensors) names.push_back(sensor.name);
  else
    for (const auto& node : scenario.own_nodes)
      if (is_actor(node)) names.push_back(node.name);
  return names;
}

bool starts_program(const NodeKind& kind, const std::string& name, const Scenario& scenario) {
  if (kind.name == std::string_view(fusion_node))
    return scenario.fusion && !scenario.fusion->node.empty();
  return kind.each_own_node ||
         (kind.each_sensor && !sensor_named(scenario, name).started_node().empty());
}

bool writes_files(const NodeKind& kind, const std::string& name, const Scenario& scenario) {
  return kind.writes_products ||
         (kind.each_own_node && std::ranges::any_of(scenario.own_nodes, [&](const OwnNode& node) {
            return node.name == name && !node.consumes.empty();
          }));
}

std::vector<std::string> nodes_of(const Scenario& scenario) {
  std::vector<std::string> all;
  for (const NodeKind& kind : table)
    for (auto& name : nodes_of(kind, scenario)) all.push_back(std::move(name));
  return all;
}

}  // namespace dmise
