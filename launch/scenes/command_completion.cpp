#include "nodes/runtime/program/completion.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "launch/command/command.h"

namespace dmise {
namespace {

void add_completion_options(CLI::App& command) {
  command.require_subcommand(1);
  const CLI::App& program = *command.get_parent();
  command.add_subcommand("bash", "for bash: eval \"$(dmise completion bash)\"")
      ->callback([&program] { std::printf("%s", bash_completion(program).c_str()); });
  command.add_subcommand("zsh", "for zsh: a file _dmise in a directory of $fpath")
      ->callback([&program] { std::printf("%s", zsh_completion(program).c_str()); });
}

}  // namespace

Command completion_command() {
  return {.group = CommandGroup::shell,
          .summary = "Prints a script that completes commands and options in a shell",
          .add_options = add_completion_options};
}

}  // namespace dmise
