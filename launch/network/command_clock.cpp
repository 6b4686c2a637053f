#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <memory>
#include <string>

#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/process/status_table.h"
#include "nodes/runtime/observability/status.h"

namespace dmise {
namespace {

struct ClockOptions {
  std::string master, keys;
  ClockRequest request;
};

void control(const ClockOptions& options) {
  constexpr double answer_within_s = 2.0;
  const Security security{options.keys, operator_name};
  const RunStatus status =
      control_master(options.master, answer_within_s, options.request, security);
  std::fputs(status_table(status).c_str(), stdout);
}

void add_pace_verb(CLI::App& clock) {
  auto options = std::make_shared<ClockOptions>();
  options->request.action = ClockAction::pace;
  auto* verb = clock.add_subcommand("pace", "sets how fast simulated time passes");
  add_master_option(*verb, "master", options->master)->required();
  verb->add_option("factor", options->request.factor,
                   "simulated seconds per second, 0 to 1e6; 0: as fast as possible")
      ->required()
      ->check(number_between(0.0, 1e6));
  verb->add_option("--keys", options->keys, "directory with operator.key");
  verb->callback([options] { control(*options); });
}

void add_clock_options(CLI::App& command) {
  command.require_subcommand(1);
  const std::map<std::string, std::pair<ClockAction, std::string>> actions{
      {"pause", {ClockAction::pause, "stop after the last granted tick, or after this one"}},
      {"step", {ClockAction::step, "run this many more ticks (default 1), then pause again"}},
      {"go-on", {ClockAction::go_on, "end a pause"}},
      {"end", {ClockAction::end_early, "end the run when all granted ticks are done"}},
      {"abort", {ClockAction::abort, "end the run at once"}}};
  for (const auto& [name, action] : actions) {
    auto options = std::make_shared<ClockOptions>();
    const bool steps = action.first == ClockAction::step;
    options->request = {.action = action.first, .tick = steps ? 1 : 0};
    auto* verb = command.add_subcommand(name, action.second);
    add_master_option(*verb, "master", options->master)->required();
    verb->add_option("--keys", options->keys, "directory with operator.key");
    if (steps || action.first == ClockAction::pause)
      verb->add_option(steps ? "ticks,--tick" : "tick,--tick", options->request.tick,
                       steps ? "number of ticks" : "tick")
          ->check(CLI::Range(Tick(steps), Tick(1) << 40));
    if (action.first == ClockAction::end_early || action.first == ClockAction::abort)
      verb->add_option("--reason", options->request.reason, "cause to record");
    verb->callback([options] { control(*options); });
  }
  add_pace_verb(command);
}

}  // namespace

Command clock_command() {
  return {.group = CommandGroup::networks,
          .summary = "Pauses, steps, paces or ends a run",
          .add_options = add_clock_options};
}

}  // namespace dmise
