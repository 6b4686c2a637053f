#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "core/base/error.h"
#include "launch/commands.h"
#include "launch/node_health.h"
#include "nodes/runtime/program/command_line.h"

namespace dmise {
namespace {

constexpr double patience_s = 1.5;  // with the start of the program below 2 s

struct HealthOptions {
  std::string name, master, keys;
};

/// To an engine of containers no other code than 0 and 1 has a meaning.
void look(const HealthOptions& options) try {
  if (options.master.empty())
    throw Error("health: --master (or DMISE_MASTER) must say where the time-master is");
  const RunStatus status =
      ask_master(options.master, patience_s, Security(options.keys, options.name));
  if (const std::string complaint = complaint_of(status, options.name); !complaint.empty())
    throw Error(complaint);
  std::printf("healthy: tick %lld of %lld\n", static_cast<long long>(status.settled),
              static_cast<long long>(status.last_tick));
} catch (const ConfigError& error) {
  throw Error(error.what());
}

}  // namespace

void add_health_command(CLI::App& app) {
  auto options = std::make_shared<HealthOptions>();
  auto* command = app.add_subcommand(
      "health", "Exits with 0 when a node is part of its run and heard, else with 1, within 2 s");
  command
      ->add_option("name", options->name,
                   "of the node (its key is used, with --keys), or time-master: the run as a whole")
      ->required();
  command->add_option("--master", options->master, "address of the time-master, tcp://HOST:PORT")
      ->envname("DMISE_MASTER")
      ->check(transport_address());
  command->add_option("--keys", options->keys, "directory with NAME.key")->envname("DMISE_KEYS");
  command->callback([options] { look(*options); });
}

}  // namespace dmise
