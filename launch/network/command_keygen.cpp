#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <memory>
#include <set>

#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/printable.h"
#include "core/config/node_kinds.h"
#include "core/config/node_names.h"
#include "core/config/scenario.h"
#include "launch/command/command.h"
#include "launch/process/host_names.h"
#include "nodes/runtime/security/security.h"

namespace dmise {
namespace {

struct KeygenOptions {
  std::string directory, scenario;
  std::vector<std::string> names;
  std::vector<std::string> nodes;  // for which they may speak
  int hosts = 0;                   // number of agents of the scenario
  bool truth = false;
  bool rings = false;
};

/// Nodes of a kind that may ask the time-master: also one that the scenario does not need, for its
/// container or task stands by until the end of the run.
std::vector<std::string> askers_of(const NodeKind& kind, const Scenario& scenario) {
  if (kind.wanted(scenario)) return nodes_of(kind, scenario);
  return {kind.name};
}

/// Throws `ConfigError` for a name that is given twice or whose key or public key exists, before
/// any key is made.
void require_new(const std::string& directory, const std::vector<std::string>& names) {
  std::set<std::string> seen;
  for (const auto& name : names) {
    if (!seen.insert(name).second)
      throw ConfigError("names: " + printable(name) + ": is given twice");
    for (const char* ending : {".key", ".pub"}) {
      const std::string path = directory + "/" + name + ending;
      if (path_exists(path)) throw ConfigError(path + ": this key exists already");
    }
  }
}

void keygen(const KeygenOptions& options) {
  std::vector<std::string> names = options.names, several;
  std::map<std::string, std::vector<std::string>> agents;  // the nodes for which they may speak
  std::map<std::string, std::vector<std::string>> rings;   // the keys in each
  if (!options.nodes.empty() && options.names.empty())
    throw ConfigError("--nodes: names of the agents are missing");
  for (const auto& name : options.names) {
    if (const auto fault = fault_of_name(name))
      throw ConfigError("names: " + *fault + ", got " + printable(name));
    if (!options.nodes.empty()) agents[name] = options.nodes;
  }
  if (!options.scenario.empty()) {
    names.insert(names.end(), {"time-master", broker_name});
    const Scenario scenario = load_scenario(options.scenario);
    for (const NodeKind& kind : node_kinds()) {
      const auto askers = askers_of(kind, scenario);
      auto& list = kind.writes_products ? several : names;
      list.insert(list.end(), askers.begin(), askers.end());
      if (kind.each_own_node) rings["own-nodes"] = askers;
    }
    names.push_back(operator_name);
    names.insert(names.end(), several.begin(), several.end());
    for (int host = 0; host < options.hosts; ++host) {
      names.push_back(agent_name(scenario, host));
      agents[names.back()] = rings[names.back()] = sensors_on(scenario, host, options.hosts);
      rings[names.back()].push_back(names.back());
    }
    rings["sensors"] = several;
  } else if (options.hosts > 0) {
    throw ConfigError("--hosts: needs --scenario");
  }
  if (options.rings && several.empty()) throw ConfigError("--rings: needs --scenario");
  if (names.empty()) names.push_back(operator_name);
  require_new(options.directory, names);
  for (const auto& name : names) {
    make_key(options.directory, name, options.truth, {agents[name].begin(), agents[name].end()});
    std::printf("%s/%s.key\n", options.directory.c_str(), name.c_str());
  }
  if (options.rings) make_rings(options.directory, rings);
}

void add_keygen_options(CLI::App& command) {
  auto options = std::make_shared<KeygenOptions>();
  command.add_option("directory", options->directory, "directory of keys")->required();
  command.add_option("names", options->names, "names of nodes of a run, observers, operator");
  command.add_option("--scenario", options->scenario, "also for every process of this scenario");
  command.add_flag("--rings", options->rings,
                   "also rings/sensors.keys, the sensors' keys in one file, rings/own-nodes.keys, "
                   "those of own nodes, rings/everybody.pubs, all public keys, and with --hosts a "
                   "ring for each agent and its sensors: for containers");
  command
      .add_option("--nodes", options->nodes,
                  "the names are agents (dmise-host-agent) that may speak for NODE[,NODE..] only")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      .add_option(
          "--hosts", options->hosts,
          "with --scenario: also for this number of agents, each for the sensors that `dmise "
          "launch --hosts` assigns to it")
      ->check(CLI::Range(0, 10000));
  command.add_flag("--truth", options->truth, "the names may receive truth");
  command.callback([options] { keygen(*options); });
}

}  // namespace

Command keygen_command() {
  return {.group = CommandGroup::networks,
          .summary = "Creates keys of nodes, observers and operators for encrypted connections",
          .details =
              "NAME.key, which only its owner may read, and NAME.pub, which grants access. Remove "
              "NAME.pub from the directory of a process to revoke the key",
          .add_options = add_keygen_options};
}

}  // namespace dmise
