#include "nodes/own/own_node_run.h"

#include <utility>

namespace dmise {

v1::OwnNodeBegin begin_of(const Scenario& scenario, const OwnNode& node) {
  v1::OwnNodeBegin begin;
  begin.set_options_json(node.options_json);
  begin.set_start_utc(scenario.start_utc);
  begin.set_tick_ns(scenario.tick.ns);
  begin.set_last_tick(scenario.last_tick());
  begin.set_period_ticks(std::uint32_t(node.period_ticks));
  begin.set_seed(scenario.seed);
  return begin;
}

ProgramSettings program_settings(const Scenario& scenario, const OwnNode& node,
                                 const OwnNodeSettings& settings) {
  ProgramSettings program{.name = node.name,
                          .command = node.run,
                          .directory = node.directory,
                          .log_path = settings.log_path,
                          .start_within_s = scenario.network.join_within_s,
                          .silent_after_s = scenario.network.silent_after_s,
                          .stop = settings.stop};
  program.command[0] = program_of(node);
  return program;
}

OwnRestarts::OwnRestarts(const NetworkConfig& network, std::string node,
                         const OwnNodeSettings& settings)
    : policy_(network.on_silent_node),
      allowed_(network.restarts),
      node_(std::move(node)),
      error_prefix_(settings.error_prefix),
      note_(settings.note) {}

void OwnRestarts::after(const ProgramLost& lost, const std::string& place) {
  const std::string text = place + ": " + lost.what();
  if (policy_ != OnSilentNode::restart || done_ >= allowed_) throw Error(error_prefix_ + text);
  ++done_;
  note_(node_ + ": " + text + ", and was restarted (" + std::to_string(done_) + " of " +
        std::to_string(allowed_) + ")");
}

}  // namespace dmise
