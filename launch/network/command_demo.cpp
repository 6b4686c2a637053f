#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/config/yaml/search_path.h"
#include "launch/command/command.h"
#include "launch/process/supervisor.h"

namespace dmise {
namespace {

/// Replaces this process by `dmise launch` of the shipped demonstration.
[[noreturn]] void launch_demo(const std::string& out, const std::vector<std::string>& more) {
  const std::string scenario = home_directory() + "/launch/scenarios/demo.yaml";
  if (!std::filesystem::is_regular_file(scenario))
    throw Error(scenario + ": the demonstration's scenario is missing");
  std::vector<std::string> arguments{"launch", scenario, "--out", out};
  arguments.insert(arguments.end(), more.begin(), more.end());
  become_program("dmise", arguments);
}

void add_demo_options(CLI::App& command) {
  auto out = std::make_shared<std::string>("out/demo");
  command.add_option("--out", *out, "directory of the products")->capture_default_str();
  command.allow_extras();
  command.callback([&command, out] { launch_demo(*out, command.remaining()); });
}

}  // namespace

Command demo_command() {
  return {
      .group = CommandGroup::scenarios,
      .summary = "Launches the shipped demonstration: two minutes of an evening with four sensors",
      .details = "Takes the options of launch",
      .add_options = add_demo_options};
}

}  // namespace dmise
