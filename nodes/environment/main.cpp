// dmise-environment-node: publishes Sun, Moon, the Earth's orientation and the atmospheres of a
// scenario.
#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "nodes/environment/environment_actor.h"
#include "nodes/runtime/node/node.h"
#include "nodes/runtime/program/program.h"

int main(int argc, char** argv) {
  dmise::CommonFlags flags{.name = dmise::environment_node};
  std::string config;
  int threads = 1;
  CLI::App app("Publishes Sun, Moon, Earth orientation and the atmosphere above each site.",
               "dmise-environment-node");
  dmise::add_common_flags(app, flags);
  app.add_option("--config", config, "scenario (YAML)")->required();
  app.add_option("--threads", threads, "accepted for compatibility; one thread is used");
  return dmise::run_program(app, flags, argc, argv, [&] {
    const dmise::Scenario scenario = dmise::load_scenario(config);
    dmise::EnvironmentActor actor(scenario, dmise::make_clock(scenario));
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
