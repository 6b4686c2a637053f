#include "nodes/program/scenario_node.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/config/node_kinds.h"
#include "nodes/runtime/node/node.h"
#include "nodes/runtime/program/program.h"

namespace dmise {

int run_scenario_node(const ScenarioNode& node, int argc, char** argv) {
  const NodeKind& kind = *std::ranges::find_if(
      node_kinds(), [&](const NodeKind& each) { return std::string_view(each.name) == node.name; });
  CommonFlags flags{.name = node.name};
  std::string config, out = "out/node";
  int threads = 1;
  CLI::App app(node.what, std::string("dmise-") + node.name);
  add_common_flags(app, flags);
  app.add_option("--config", config, "scenario (YAML)")->required();
  if (kind.writes_products)
    app.add_option("--out", out, "directory of the run")->capture_default_str();
  app.add_option(
         "--threads", threads,
         node.uses_threads ? "number of threads" : "accepted for compatibility; one thread is used")
      ->check(CLI::Range(1, 256));
  bool allowed = false;
  if (node.starts_programs)
    app.add_flag("--allow-programs", allowed, "runs the program that the scenario names");
  return run_program(app, flags, argc, argv, [&] {
    const Scenario scenario = load_scenario(config);
    if (!kind.wanted(scenario))
      throw ConfigError(config + ": " + node.needs + ": is required for this node");
    if (flags.check && kind.writes_products) return 0;
    Threads pool(node.uses_threads ? threads : 1);
    const auto participant = node.make({scenario, pool, out, allowed});
    if (flags.check) return 0;
    if (flags.master.empty()) throw ConfigError("--master: is required");
    return run_node(*participant, {.master = flags.master,
                                   .host = flags.host,
                                   .join_within_s = scenario.network.join_within_s,
                                   .keys = flags.keys,
                                   .via = flags.via,
                                   .stop = &stop_signal()})
        .exit_code;
  });
}

}  // namespace dmise
