#include <CLI/CLI.hpp>
#include <memory>

#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/process/supervisor.h"
#include "launch/process/view_process.h"

namespace dmise {
namespace {

void add_view_options(CLI::App& command) {
  auto options = std::make_shared<ViewOptions>();
  add_master_option(command, "master", options->master)->required();
  command.add_option("--products", options->products,
                     "directory of the run: previews of frames that no sensor serves any more");
  command
      .add_option("--listen", options->listen,
                  "IP address and port of the pages; addresses other than loopback need --tokens")
      ->capture_default_str();
  command.add_option("--keys", options->keys,
                     "directory with gateway.key, and operator.key to control the clock");
  command.add_option("--tokens", options->tokens,
                     "file with `view TOKEN`, `truth TOKEN` and `operator TOKEN`: who may watch, "
                     "also see truth, also control the clock");
  command.add_flag(
      "--truth", options->truth,
      "show truth beside detections to viewers that may see it; with keys gateway.key must "
      "be one of `dmise keygen --truth`");
  options->answer_within_s = 10.0;
  command
      .add_option("--answer-within", options->answer_within_s,
                  "end with an error if no time-master has answered in this time [s]; 0: wait")
      ->capture_default_str()
      ->check(number_between(0.0, 1e6));
  command.add_flag("--no-control", options->no_control, "viewers cannot control the clock");
  command.callback([options] { become(gateway_command(*options)); });
}

}  // namespace

Command view_command() {
  return {.group = CommandGroup::networks,
          .summary = "Shows a run, or a replayed recording, in browsers",
          .details = "Prints the URL; ends by Ctrl-C",
          .add_options = add_view_options};
}

}  // namespace dmise
