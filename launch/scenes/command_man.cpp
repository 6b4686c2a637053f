#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "launch/command/command.h"
#include "nodes/runtime/program/manual.h"
#include "nodes/runtime/program/version_text.h"

namespace dmise {
namespace {

void print_page(const CLI::App& app, const std::string& name) {
  const std::string version = version_text(app.get_name());
  std::vector<std::string> pages;
  for (const CLI::App* command : shown_commands(app)) {
    pages.push_back(command->get_name());
    if (command->get_name() != name) continue;
    std::printf(
        "%s",
        manual_page(*command, app.get_name() + "-" + name, version, {app.get_name()}).c_str());
    return;
  }
  if (!name.empty())
    throw ConfigError("man: there is no command " + name + did_you_mean(name, pages));
  for (auto& page : pages) page = app.get_name() + "-" + page;
  std::printf("%s", manual_page(app, app.get_name(), version, pages).c_str());
}

void add_man_options(CLI::App& command) {
  auto name = std::make_shared<std::string>();
  auto list = std::make_shared<bool>(false);
  command.add_option("name", *name, "name of a command; without it the page of dmise");
  command.add_flag("--list", *list, "the names of commands that have a page");
  const CLI::App& program = *command.get_parent();
  command.callback([&program, name, list] {
    if (!*list) return print_page(program, *name);
    for (const CLI::App* page : shown_commands(program))
      std::printf("%s\n", page->get_name().c_str());
  });
}

}  // namespace

Command man_command() {
  return {.group = CommandGroup::shell,
          .summary = "Prints the manual page of dmise or of a command: dmise man run | man -l -",
          .add_options = add_man_options};
}

}  // namespace dmise
