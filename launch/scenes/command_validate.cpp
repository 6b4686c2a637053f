#include <CLI/CLI.hpp>

#include "launch/command/commands.h"
#include "launch/process/supervisor.h"

namespace dmise {

void add_validate_command(CLI::App& app) {
  auto* command = app.add_subcommand(
      "validate",
      "Compares the models with measurements of the sky, and writes a page of what differs");
  command->set_help_flag();  // the program has its own
  command->prefix_command();
  command->callback([command] { become_program("dmise-validate", command->remaining()); });
}

}  // namespace dmise
