#include <CLI/CLI.hpp>
#include <memory>

#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/run/launched_run.h"

namespace dmise {
namespace {

void add_launch_options(CLI::App& command) {
  auto options = std::make_shared<LaunchOptions>();
  command.add_option("scenario", options->scenario, "scenario (YAML)")->required();
  command.add_option("--out", options->out, "directory of the products")->default_val("out/launch");
  command.add_option("--bind", options->bind, "address of the time-master; port 0: any free port")
      ->capture_default_str()
      ->check(transport_address());
  add_threads_option(command, options->threads,
                     "threads of each node; the products do not depend on it");
  command
      .add_option("--hosts", options->hosts,
                  "number of agents that the sensors join, one per host; 0: none")
      ->default_val(0)
      ->check(CLI::Range(0, 10000));
  add_seed_option(command, options->seed, "seed of the random numbers, instead of the scenario's");
  command.add_option("--plan", options->plan,
                     "run.json of a run: its frames' levels of effects instead of a plan");
  command.add_option("--keys", options->keys,
                     "directory of keys (dmise keygen); without it no encryption, loopback only");
  command.add_option("--metrics", options->metrics,
                     "serve Prometheus metrics: at [HOST:]PORT of the time-master, at the next "
                     "ports of the other processes; auto: any ports, see the logs");
  command
      .add_option("--log-format", options->log_format,
                  "format of the processes' logs: text or json")
      ->capture_default_str();
  auto* view = command.add_flag("--view", options->view,
                                "show the run in browsers on this machine; prints the URL");
  command
      .add_flag("--view-truth", options->view_truth,
                "show truth beside detections there; with keys gateway.key must be one of `dmise "
                "keygen --truth`")
      ->needs(view);
  command.add_flag("--nodes-elsewhere", options->nodes_elsewhere,
                   "start only the time-master; other nodes are started by `dmise join`");
  add_allow_programs_flag(command, options->allow_programs);
  command.add_flag("--force", options->force, "replace the products in the directory");
  command.callback([options] { launch(*options); });
}

}  // namespace

Command launch_command() {
  return {.group = CommandGroup::networks,
          .summary = "Runs a scenario as a network: broker, time-master and a process per node",
          .add_options = add_launch_options};
}

}  // namespace dmise
