#include <CLI/CLI.hpp>

#include "launch/command/commands.h"
#include "launch/process/supervisor.h"

namespace dmise {

void add_bench_command(CLI::App& app) {
  auto* command = app.add_subcommand("bench", "Runs benchmarks; with --json one object per line");
  command->set_help_flag();  // the benchmark program has its own
  command->prefix_command();
  command->callback([command] {
    const auto arguments = command->remaining();
    const bool study =
        !arguments.empty() && (arguments.front() == "paper" || arguments.front() == "scaling");
    become_program(study ? "dmise-studies" : "dmise-bench", arguments);
  });
}

}  // namespace dmise
