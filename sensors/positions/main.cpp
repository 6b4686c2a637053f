// dmise-positions-node: writes the positions of a scenario's cameras and platforms, its own
// objects, Sun and Moon.
#include "core/config/make_clock.h"
#include "core/config/node_kinds.h"
#include "nodes/program/scenario_node.h"
#include "sensors/positions/positions_evaluator.h"

int main(int argc, char** argv) {
  return dmise::run_scenario_node(
      {.name = dmise::positions_node,
       .what = "Writes the positions of a scenario's cameras, platforms, objects, Sun and Moon.",
       .needs = "output.positions",
       .make =
           [](const dmise::ScenarioNode::Inputs& in) {
             return std::make_unique<dmise::PositionsEvaluator>(
                 in.scenario, dmise::make_clock(in.scenario), in.directory);
           }},
      argc, argv);
}
