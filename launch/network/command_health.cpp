#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "core/base/error.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/process/node_health.h"

namespace dmise {
namespace {

constexpr double health_within_s = 1.5;  // below 2 s including the program's start

struct HealthOptions {
  std::string name, master, keys;
};

/// Container engines know no exit codes but 0 and 1.
void check_health(const HealthOptions& options) try {
  if (options.master.empty())
    throw Error("health: --master (or DMISE_MASTER) must give the time-master's address");
  const RunStatus status =
      ask_master(options.master, health_within_s, Security(options.keys, options.name));
  if (const std::string complaint = health_problem(status, options.name); !complaint.empty())
    throw Error(complaint);
  std::printf("healthy: tick %lld of %lld\n", static_cast<long long>(status.settled),
              static_cast<long long>(status.last_tick));
} catch (const ConfigError& error) {
  throw Error(error.what());
}

void add_health_options(CLI::App& command) {
  auto options = std::make_shared<HealthOptions>();
  command
      .add_option(
          "name", options->name,
          "name of the node (whose key is used, with --keys), or time-master: the whole run")
      ->required();
  add_master_option(command, "--master", options->master)->envname("DMISE_MASTER");
  command.add_option("--keys", options->keys, "directory with NAME.key")->envname("DMISE_KEYS");
  command.callback([options] { check_health(*options); });
}

}  // namespace

Command health_command() {
  return {.group = CommandGroup::networks,
          .summary = "Exits with 0 if a node is alive in its run, else with 1, within 2 s",
          .add_options = add_health_options};
}

}  // namespace dmise
