#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "core/config/schema.h"
#include "launch/command/command.h"

namespace dmise {
namespace {

void add_schema_options(CLI::App& command) {
  command.require_subcommand(1);
  for (const FileKind& kind : file_kinds()) {
    auto* one = command.add_subcommand(std::string(kind.name), "of " + std::string(kind.what));
    auto markdown = std::make_shared<bool>(false);
    one->add_flag("--markdown", *markdown, "the reference page instead, in Markdown");
    one->callback([&kind, markdown] {
      std::printf("%s", (*markdown ? schema_markdown(kind) : json_schema(kind)).c_str());
    });
  }
}

}  // namespace

Command schema_command() {
  return {.group = CommandGroup::scenarios,
          .summary = "Prints the JSON Schema of files, by which editors complete and check them",
          .add_options = add_schema_options};
}

}  // namespace dmise
