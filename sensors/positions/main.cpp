// dmise-positions-node: writes the positions of a scenario's cameras and platforms, its own
// objects, Sun and Moon.
#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "nodes/runtime/node/node.h"
#include "nodes/runtime/program/program.h"
#include "sensors/positions/positions_evaluator.h"

int main(int argc, char** argv) {
  dmise::CommonFlags flags{.name = dmise::positions_node};
  std::string config, out = "out/node";
  int threads = 1;
  CLI::App app("Writes the positions of a scenario's cameras, platforms, objects, Sun and Moon.",
               "dmise-positions-node");
  dmise::add_common_flags(app, flags);
  app.add_option("--config", config, "scenario (YAML)")->required();
  app.add_option("--out", out, "directory of the run")->capture_default_str();
  app.add_option("--threads", threads, "accepted for compatibility; one thread is used");
  return dmise::run_program(app, flags, argc, argv, [&] {
    const dmise::Scenario scenario = dmise::load_scenario(config);
    if (!scenario.output.positions())
      throw dmise::ConfigError(config + ": output.positions: is required for this node");
    if (flags.check) return 0;
    if (flags.master.empty()) throw dmise::ConfigError("--master: is required");
    dmise::PositionsEvaluator evaluator(scenario, dmise::make_clock(scenario), out);
    return dmise::run_node(evaluator, {.master = flags.master,
                                       .host = flags.host,
                                       .join_within_s = scenario.network.join_within_s,
                                       .keys = flags.keys,
                                       .via = flags.via,
                                       .stop = &dmise::stop_signal()})
        .exit_code;
  });
}
