#pragma once
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "launch/run/run_directory.h"
#include "nodes/runtime/observability/status.h"

namespace dmise {

/// How a run ended.
struct RunOutcome {
  /// complete; incomplete: without dropped nodes; ended: early, on request; interrupted; failed
  std::string status = "complete";
  std::string how;                   // "one process" or "a process per node"
  std::string reason;                // unless complete or interrupted
  double wall_s = 0.0;               // with that of the parts before
  int parts = 1;                     // in which it was made: more than one of a run that went on
  std::vector<NodeStatus> nodes;     // one per process
  std::vector<std::string> dropped;  // nodes that the run went on without
};

/// Writes run.json: what ran, seed, digests, plan, time per effect and frame. The only product with
/// wall-clock values, besides the sensors' cost.jsonl that it summarises.
void write_run_record(const RunDirectory& directory, const Scenario& scenario,
                      const RunOutcome& outcome);

/// Writes index.html, the report of the run; prints a note if it can't. `pixels`: as in
/// `write_report`.
void write_index_page(const RunDirectory& directory, bool pixels = true);
bool has_index_page(const RunDirectory& directory);

/// Suggests what to open: the first marked picture and the index page, if they exist.
std::string what_to_open(const RunDirectory& directory, const Scenario& scenario);

/// The table at the end of a run and what to open.
std::string summary_text(const RunDirectory& directory, const Scenario& scenario,
                         const RunOutcome& outcome);

}  // namespace dmise
