// dmise-environment-node: publishes Sun, Moon, the Earth's orientation and the atmospheres of a
// scenario.
#include "core/config/make_clock.h"
#include "core/config/node_kinds.h"
#include "nodes/environment/environment_actor.h"
#include "nodes/program/scenario_node.h"

int main(int argc, char** argv) {
  return dmise::run_scenario_node(
      {.name = dmise::environment_node,
       .what = "Publishes Sun, Moon, Earth orientation and the atmosphere above each site.",
       .make =
           [](const dmise::ScenarioNode::Inputs& in) {
             return std::make_unique<dmise::EnvironmentActor>(in.scenario,
                                                              dmise::make_clock(in.scenario));
           }},
      argc, argv);
}
