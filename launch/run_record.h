#pragma once
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "launch/run_directory.h"

namespace dmise {

/// Where one node's time went [s of wall clock].
struct NodeTimes {
  std::string name;
  double compute_s = 0.0, messaging_s = 0.0, waiting_s = 0.0;
};

/// How a run ended.
struct RunOutcome {
  std::string status = "complete";  // complete | interrupted | failed
  std::string how;                  // "one process" or "a process per node"
  std::string reason;               // of a failure
  double wall_s = 0.0;
  std::vector<NodeTimes> nodes;
};

/// Writes run.json: what ran, seed, digests, plan, time per effect and frame. The only product that
/// holds wall-clock values, beside the sensors' cost.jsonl that it gathers.
void write_run_record(const RunDirectory& directory, const Scenario& scenario,
                      const RunOutcome& outcome);

/// Writes index.html: the sensors, their frames and pictures.
void write_index_page(const RunDirectory& directory, const Scenario& scenario);
bool has_index_page(const RunDirectory& directory);

/// Lines that say what to look at: the first marked picture and the page, where there are such.
std::string what_to_open(const RunDirectory& directory, const Scenario& scenario);

/// The table at the end of a run and what to open.
std::string summary_text(const RunDirectory& directory, const Scenario& scenario,
                         const RunOutcome& outcome);

}  // namespace dmise
