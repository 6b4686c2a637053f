// dmise-fusion-node: makes tracks of the detections of a scenario's sensors.
#include "core/config/make_clock.h"
#include "core/config/node_kinds.h"
#include "nodes/fusion/fusion_evaluator.h"
#include "nodes/program/scenario_node.h"

int main(int argc, char** argv) {
  return dmise::run_scenario_node(
      {.name = dmise::fusion_node,
       .what = "Makes tracks of objects from the detections of all sensors of a scenario.",
       .needs = "fusion",
       .make =
           [](const dmise::ScenarioNode::Inputs& in) {
             return std::make_unique<dmise::FusionEvaluator>(
                 in.scenario, dmise::make_clock(in.scenario), in.directory);
           }},
      argc, argv);
}
