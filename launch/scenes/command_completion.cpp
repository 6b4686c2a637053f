#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "launch/command/command.h"
#include "nodes/runtime/program/manual.h"

namespace dmise {
namespace {

/// Calls `visit(path, app)` for a program and its commands; a path is "dmise list cameras".
void for_commands(const CLI::App& app, const std::string& path,
                  const std::function<void(const std::string&, const CLI::App&)>& visit) {
  visit(path, app);
  for (const CLI::App* sub : shown_commands(app))
    for_commands(*sub, path + " " + sub->get_name(), visit);
}

std::vector<std::string> option_names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const auto& name : option.get_lnames()) names.push_back("--" + name);
  for (const auto& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

/// Patterns of the paths that lead further, as "a b"|"a c".
std::string paths(const CLI::App& app) {
  std::string all;
  for_commands(app, app.get_name(), [&](const std::string& path, const CLI::App& at) {
    if (&at != &app) all += (all.empty() ? "\"" : "|\"") + path + "\"";
  });
  return all;
}

std::string quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find('\'', at)) != text.npos; at += 4)
    text.replace(at, 1, "'\\''");
  return "'" + text + "'";
}

/// NAME:TEXT of zsh's lists.
std::string described(std::string name, std::string text) {
  for (std::size_t at = 0; (at = name.find(':', at)) != name.npos; at += 2) name.insert(at, "\\");
  text.resize(std::min(text.size(), text.find('\n')));
  return quoted(name + ":" + text);
}

// Scripts for shells that complete commands and options of a program, and names of files elsewhere.
std::string bash_completion(const CLI::App& app) {
  const std::string& name = app.get_name();
  const std::string function = "_" + name;
  std::string text = "# Completion of " + name + " for bash: written by `" + name +
                     " completion bash`.\n" + function +
                     "() {\n  local current=${COMP_WORDS[COMP_CWORD]} at=" + name +
                     " word commands='' options=''\n"
                     "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
                     "    case \"$at $word\" in\n      " +
                     paths(app) + ") at=\"$at $word\" ;;\n    esac\n  done\n  case $at in\n";
  for_commands(app, name, [&](const std::string& path, const CLI::App& at) {
    std::string commands, options;
    for (const CLI::App* sub : shown_commands(at))
      commands += (commands.empty() ? "" : " ") + sub->get_name();
    for (const CLI::Option* option : shown_options(at))
      for (const auto& word : option_names(*option)) options += (options.empty() ? "" : " ") + word;
    text += "    \"" + path + "\") commands='" + commands + "' options='" + options + "' ;;\n";
  });
  text +=
      "  esac\n"
      "  COMPREPLY=()\n"
      "  if [[ $current == -* ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$current\")\n"
      "  elif [[ -n $commands ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$commands\" -- \"$current\")\n"
      "  fi\n"
      "}\n"
      "complete -o default -F " +
      function + " " + name + "\n";
  return text;
}

std::string zsh_completion(const CLI::App& app) {
  const std::string& name = app.get_name();
  const std::string function = "_" + name;
  std::string text = "#compdef " + name + "\n# Written by `" + name + " completion zsh`.\n" +
                     function + "() {\n  local at=" + name +
                     " word\n  local -a commands options\n"
                     "  for word in ${words[2,CURRENT-1]}; do\n"
                     "    case \"$at $word\" in\n      (" +
                     paths(app) + ") at=\"$at $word\" ;;\n    esac\n  done\n  case $at in\n";
  for_commands(app, name, [&](const std::string& path, const CLI::App& at) {
    text += "    (\"" + path + "\")\n      commands=(";
    for (const CLI::App* sub : shown_commands(at))
      text += "\n        " + described(sub->get_name(), sub->get_description());
    text += ")\n      options=(";
    for (const CLI::Option* option : shown_options(at))
      for (const auto& word : option_names(*option))
        text += "\n        " + described(word, option->get_description());
    text += ") ;;\n";
  });
  text +=
      "  esac\n"
      "  if [[ $words[CURRENT] == -* ]]; then\n"
      "    _describe -o option options\n"
      "  elif (( $#commands )); then\n"
      "    _describe command commands\n"
      "  else\n"
      "    _files\n"
      "  fi\n"
      "}\n" +
      function + " \"$@\"\n";
  return text;
}

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
