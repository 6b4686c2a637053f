#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "core/base/error.h"
#include "core/config/scenario.h"
#include "launch/commands.h"
#include "nodes/runtime/security.h"
#include "sensors/positions/positions_evaluator.h"

namespace dmise {
namespace {

struct KeygenOptions {
  std::string directory, scenario;
  std::vector<std::string> names;
  bool truth = false;
  bool rings = false;
};

void keygen(const KeygenOptions& options) {
  std::vector<std::string> names = options.names, several;
  if (!options.scenario.empty()) {
    for (const char* name :
         {"time-master", "broker", "orbit-node", "environment-node", operator_name})
      names.push_back(name);
    const Scenario scenario = load_scenario(options.scenario);
    for (const auto& sensor : scenario.sensors) several.push_back(sensor.name);
    if (scenario.output.positions()) several.push_back(positions_node);
    names.insert(names.end(), several.begin(), several.end());
  }
  if (options.rings && several.empty())
    throw ConfigError("--rings: needs --scenario: rings are of its sensors");
  if (names.empty()) names.push_back(operator_name);
  for (const auto& name : names) {
    make_key(options.directory, name, options.truth);
    std::printf("%s/%s.key\n", options.directory.c_str(), name.c_str());
  }
  if (options.rings) make_rings(options.directory, "sensors", several);
}

}  // namespace

void add_keygen_command(CLI::App& app) {
  auto options = std::make_shared<KeygenOptions>();
  auto* command =
      app.add_subcommand("keygen",
                         "Makes keys: NAME.key, which its owner alone may read, and NAME.pub, "
                         "which lets it in. Remove "
                         "NAME.pub from where a process looks, and the key opens nothing any more");
  command->add_option("directory", options->directory, "directory of keys")->required();
  command->add_option("names", options->names, "whose keys: nodes of a run, observers, operator");
  command->add_option("--scenario", options->scenario, "also for every process of this scenario");
  command->add_flag("--rings", options->rings,
                    "also rings/sensors.keys, the sensors' keys in one file, and "
                    "rings/everybody.pubs, all public halves: for containers");
  command->add_flag("--truth", options->truth, "these may hear truth");
  command->callback([options] { keygen(*options); });
}

}  // namespace dmise
