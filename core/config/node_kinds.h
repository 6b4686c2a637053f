#pragma once
#include <span>
#include <string>
#include <vector>

#include "core/config/scenario.h"

namespace dmise {

inline constexpr const char *orbit_node = "orbit-node", *environment_node = "environment-node",
                            *positions_node = "positions-node", *fusion_node = "fusion-node",
                            *any_sensor = "sensor", *any_own_node = "own-node";

/// A kind of node of a run. To add one: write its participant and its program, give it a row here
/// and a maker in launch/run/node_makers.cpp, and a service in launch/stack/compose.yaml.
struct NodeKind {
  const char* name;                 // node name, unless each sensor or own node is one
  const char* program;              // in the directory of the command
  std::vector<std::string> topics;  // published; a sensor's or own node's name follows a trailing /
  bool (*wanted)(const Scenario&);
  bool writes_products = false;  // into the directory of the run
  bool each_sensor = false;
  bool each_own_node = false;  // one for each program of the user's that moves or turns objects
};

/// The table of kinds, in the order in which their nodes are started and called.
std::span<const NodeKind> node_kinds();
/// Kind of a node of the scenario, needed by it or not; null for any other name.
const NodeKind* kind_of_node(const std::string& name, const Scenario& scenario);
/// Names of the nodes of a kind that the scenario needs.
std::vector<std::string> nodes_of(const NodeKind& kind, const Scenario& scenario);
/// Names of all nodes that the scenario needs.
std::vector<std::string> nodes_of(const Scenario& scenario);
/// Whether the process of such a node writes products, or a journal of what it hears, into the
/// directory of the run.
bool writes_files(const NodeKind& kind, const std::string& name, const Scenario& scenario);
/// Whether the process of such a node starts a program of the user's.
bool starts_program(const NodeKind& kind, const std::string& name, const Scenario& scenario);

}  // namespace dmise
