#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstring>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "launch/commands.h"
#include "launch/supervisor.h"

namespace dmise {
namespace {

/// Replaces this process by the benchmark program. Throws `Error` if it is missing.
[[noreturn]] void become_bench(std::vector<std::string> arguments) {
  const std::string program = program_directory() + "/dmise-bench";
  arguments.insert(arguments.begin(), program);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  throw Error(program + ": " + std::strerror(errno));
}

}  // namespace

void add_bench_command(CLI::App& app) {
  auto* command = app.add_subcommand("bench", "Runs benchmarks; with --json one object per line");
  command->set_help_flag();  // the benchmark program has its own
  command->prefix_command();
  command->callback([command] { become_bench(command->remaining()); });
}

}  // namespace dmise
