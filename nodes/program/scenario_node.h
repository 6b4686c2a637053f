#pragma once
#include <functional>
#include <memory>
#include <string>

#include "core/base/parallel.h"
#include "core/config/scenario.h"
#include "core/sim/participant.h"

namespace dmise {

/// The program of a node that is one participant of a scenario.
struct ScenarioNode {
  struct Inputs {
    const Scenario& scenario;
    Threads& threads;
    std::string directory;  // where the run is, if the node writes products
    bool allow_programs;    // whether the scenario may start programs
  };

  const char* name;             // its row in node_kinds(); the program is dmise-NAME
  const char* what;             // what it does, for --help
  const char* needs = nullptr;  // key that a scenario with such a node has
  bool uses_threads = false;
  bool starts_programs = false;  // --allow-programs permits it
  /// Throws ConfigError for a scenario that the node cannot run. With --check it is called only if
  /// the node writes no products.
  std::function<std::unique_ptr<Participant>(const Inputs&)> make = {};
};

/// Reads the flags and the scenario, makes the participant and runs it until the end of the run.
/// Returns the exit code of the process.
int run_scenario_node(const ScenarioNode& node, int argc, char** argv);

}  // namespace dmise
