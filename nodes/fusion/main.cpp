// dmise-fusion-node: makes tracks of the detections of a scenario's sensors.
#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "nodes/fusion/fusion_evaluator.h"
#include "nodes/runtime/node/node.h"
#include "nodes/runtime/program/program.h"

int main(int argc, char** argv) {
  dmise::CommonFlags flags{.name = dmise::fusion_node};
  std::string config, out = "out/node";
  int threads = 1;
  CLI::App app("Makes tracks of objects from the detections of all sensors of a scenario.",
               "dmise-fusion-node");
  dmise::add_common_flags(app, flags);
  app.add_option("--config", config, "scenario (YAML)")->required();
  app.add_option("--out", out, "directory of the run")->capture_default_str();
  app.add_option("--threads", threads, "accepted for compatibility; one thread is used");
  return dmise::run_program(app, flags, argc, argv, [&] {
    const dmise::Scenario scenario = dmise::load_scenario(config);
    if (!scenario.fusion) throw dmise::ConfigError(config + ": fusion: is required for this node");
    if (flags.check) return 0;
    if (flags.master.empty()) throw dmise::ConfigError("--master: is required");
    dmise::FusionEvaluator evaluator(scenario, dmise::make_clock(scenario), out);
    return dmise::run_node(evaluator, {.master = flags.master,
                                       .host = flags.host,
                                       .join_within_s = scenario.network.join_within_s,
                                       .keys = flags.keys,
                                       .via = flags.via,
                                       .stop = &dmise::stop_signal()})
        .exit_code;
  });
}
