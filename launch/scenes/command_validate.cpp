#include <CLI/CLI.hpp>

#include "launch/command/command.h"
#include "launch/process/supervisor.h"

namespace dmise {
namespace {

void add_validate_options(CLI::App& command) {
  command.set_help_flag();  // the program has its own
  command.prefix_command();
  command.callback([&command] { become_program("dmise-validate", command.remaining()); });
}

}  // namespace

Command validate_command() {
  return {.group = CommandGroup::accuracy,
          .summary =
              "Compares the models with measurements of the sky, and writes a page of what differs",
          .add_options = add_validate_options};
}

}  // namespace dmise
