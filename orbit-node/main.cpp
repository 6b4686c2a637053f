// dmise-orbit-node: publishes the states of all objects of a scenario at every tick.
#include <spdlog/spdlog.h>

#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "nodes/runtime/node/node.h"
#include "nodes/runtime/program/program.h"
#include "orbit-node/orbit_actor.h"

int main(int argc, char** argv) {
  dmise::CommonFlags flags{.name = dmise::orbit_node};
  std::string config;
  int threads = 1;
  CLI::App app("Publishes the states of all objects of a scenario.", "dmise-orbit-node");
  dmise::add_common_flags(app, flags);
  app.add_option("--config", config, "scenario (YAML)")->required();
  app.add_option("--threads", threads, "number of threads")->check(CLI::Range(1, 256));
  return dmise::run_program(app, flags, argc, argv, [&] {
    const dmise::Scenario scenario = dmise::load_scenario(config);
    dmise::Threads pool(threads);
    dmise::OrbitActor actor(scenario, dmise::make_clock(scenario), pool);
    for (const auto& note : actor.notes()) spdlog::info("{}", note);
    actor.on_absence([](const std::string& line) { spdlog::info("{}", line); });
    if (flags.check) return 0;
    if (flags.master.empty()) throw dmise::ConfigError("--master: is required");
    return dmise::run_node(actor, {.master = flags.master,
                                   .host = flags.host,
                                   .join_within_s = scenario.network.join_within_s,
                                   .keys = flags.keys,
                                   .via = flags.via,
                                   .stop = &dmise::stop_signal()})
        .exit_code;
  });
}
