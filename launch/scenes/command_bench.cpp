#include <CLI/CLI.hpp>

#include "launch/command/command.h"
#include "launch/process/supervisor.h"

namespace dmise {
namespace {

void add_bench_options(CLI::App& command) {
  command.set_help_flag();  // the benchmark program has its own
  command.prefix_command();
  command.callback([&command] {
    const auto arguments = command.remaining();
    const bool study =
        !arguments.empty() && (arguments.front() == "paper" || arguments.front() == "scaling");
    become_program(study ? "dmise-studies" : "dmise-bench", arguments);
  });
}

}  // namespace

Command bench_command() {
  return {.group = CommandGroup::accuracy,
          .summary = "Runs benchmarks; with --json one object per line",
          .add_options = add_bench_options};
}

}  // namespace dmise
