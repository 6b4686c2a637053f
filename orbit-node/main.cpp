// dmise-orbit-node: publishes the states of all objects of a scenario at every tick.
#include <spdlog/spdlog.h>

#include "core/config/make_clock.h"
#include "core/config/node_kinds.h"
#include "nodes/program/scenario_node.h"
#include "orbit-node/orbit_actor.h"

int main(int argc, char** argv) {
  return dmise::run_scenario_node(
      {.name = dmise::orbit_node,
       .what = "Publishes the states of all objects of a scenario.",
       .uses_threads = true,
       .make =
           [](const dmise::ScenarioNode::Inputs& in) {
             auto actor = std::make_unique<dmise::OrbitActor>(
                 in.scenario, dmise::make_clock(in.scenario), in.threads);
             for (const auto& note : actor->notes()) spdlog::info("{}", note);
             actor->on_absence([](const std::string& line) { spdlog::info("{}", line); });
             return actor;
           }},
      argc, argv);
}
