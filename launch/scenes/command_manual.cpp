#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "launch/command/commands.h"
#include "nodes/runtime/program/completion.h"
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

}  // namespace

void add_manual_commands(CLI::App& app) {
  auto name = std::make_shared<std::string>();
  auto list = std::make_shared<bool>(false);
  auto* manual = app.add_subcommand(
      "man", "Prints the manual page of dmise or of a command: dmise man run | man -l -");
  manual->add_option("name", *name, "name of a command; without it the page of dmise");
  manual->add_flag("--list", *list, "the names of commands that have a page");
  manual->callback([&app, name, list] {
    if (!*list) return print_page(app, *name);
    for (const CLI::App* command : shown_commands(app))
      std::printf("%s\n", command->get_name().c_str());
  });
  auto* completion = app.add_subcommand(
      "completion", "Prints a script that completes commands and options in a shell");
  completion->require_subcommand(1);
  completion->add_subcommand("bash", "for bash: eval \"$(dmise completion bash)\"")
      ->callback([&app] { std::printf("%s", bash_completion(app).c_str()); });
  completion->add_subcommand("zsh", "for zsh: a file _dmise in a directory of $fpath")
      ->callback([&app] { std::printf("%s", zsh_completion(app).c_str()); });
}

}  // namespace dmise
