// dmise-own-node: runs a program of the user's as a node of a run: an actor that moves objects.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>

#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "nodes/own/own_actor.h"
#include "nodes/own/own_program.h"
#include "nodes/runtime/node/node.h"
#include "nodes/runtime/program/program.h"

namespace {

/// The node, with the program that is to run: that of the command line takes the place of the
/// scenario's.
dmise::OwnNode node_named(const dmise::Scenario& scenario, const std::string& name,
                          const std::vector<std::string>& command, bool allowed) {
  const auto found = std::ranges::find(scenario.own_nodes, name, &dmise::OwnNode::name);
  if (found == scenario.own_nodes.end())
    throw dmise::ConfigError("--name: no node of " + scenario.path + " has this name, got " + name);
  dmise::OwnNode node = *found;
  if (!command.empty()) {
    node.run = command;
    node.directory = std::filesystem::current_path().string();
    if (dmise::program_of(node).empty())
      throw dmise::ConfigError("--: there is no such program, got " + command[0]);
  } else if (node.run.empty()) {
    throw dmise::ConfigError(node.where +
                             ": is elsewhere: what does it run? dmise join has --program");
  } else if (!allowed) {
    dmise::refuse_programs({node});
  }
  return node;
}

}  // namespace

int main(int argc, char** argv) {
  dmise::CommonFlags flags;
  std::string config, directory;
  std::vector<std::string> command;
  bool allowed = false;
  int threads = 1;
  CLI::App app("Runs a program of the user's as a node of a run: it moves objects of the scenario.",
               "dmise-own-node");
  dmise::add_common_flags(app, flags);
  app.add_option("--config", config, "scenario (YAML)")->required();
  app.add_option("--out", directory,
                 "directory of the run, for the journal of a node that consumes topics");
  app.add_option("--threads", threads, "accepted for compatibility; one thread is used");
  app.add_flag("--allow-programs", allowed, "runs the program that the scenario names");
  app.add_option("program", command, "after --: program and arguments, instead of the scenario's");
  return dmise::run_program(app, flags, argc, argv, [&] {
    const dmise::Scenario scenario = dmise::load_scenario(config);
    const dmise::OwnNode node = node_named(scenario, flags.name, command, allowed);
    if (!node.consumes.empty() && directory.empty())
      throw dmise::ConfigError("--out: is required of a node that consumes topics");
    dmise::OwnActor actor(scenario, node, dmise::make_clock(scenario),
                          {.start = dmise::start_program,
                           .journal_path = dmise::input_journal_path(directory, node.name),
                           .note = [](const std::string& line) { spdlog::warn("{}", line); },
                           .stop = &dmise::stop_signal()});
    if (flags.check) return 0;
    if (flags.master.empty()) throw dmise::ConfigError("--master: is required");
    return dmise::run_node(actor, {.master = flags.master,
                                   .host = flags.host,
                                   .join_within_s = scenario.network.join_within_s,
                                   .stop_within_s = 1.0,
                                   .keys = flags.keys,
                                   .via = flags.via,
                                   .stop = &dmise::stop_signal()})
        .exit_code;
  });
}
