// dmise-fusion-node: makes tracks of the detections of a scenario's sensors.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>

#include "core/base/files/paths.h"
#include "core/config/make_clock.h"
#include "core/config/node_kinds.h"
#include "nodes/fusion/fusion_evaluator.h"
#include "nodes/own/own_program.h"
#include "nodes/program/scenario_node.h"
#include "nodes/runtime/process/event.h"

namespace {

std::unique_ptr<dmise::Participant> make(const dmise::ScenarioNode::Inputs& in) {
  const std::string& name = in.scenario.fusion->node;
  if (!name.empty() && !in.allow_programs)
    dmise::refuse_programs(
        {*std::ranges::find(in.scenario.own_nodes, name, &dmise::OwnNode::name)});
  if (!name.empty()) dmise::make_directories(in.directory + "/logs");
  return std::make_unique<dmise::FusionEvaluator>(
      in.scenario, dmise::make_clock(in.scenario), in.directory,
      dmise::OwnNodeSettings{.start = dmise::start_program,
                             .note = [](const std::string& line) { spdlog::warn("{}", line); },
                             .stop = &dmise::stop_signal()});
}

}  // namespace

int main(int argc, char** argv) {
  return dmise::run_scenario_node(
      {.name = dmise::fusion_node,
       .what = "Makes tracks of objects from the detections of all sensors of a scenario.",
       .needs = "fusion",
       .starts_programs = true,
       .make = make},
      argc, argv);
}
