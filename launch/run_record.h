#pragma once
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "launch/run_directory.h"

namespace dmise {

/// Wall-clock time of one node by activity [s], and what it needed.
struct NodeTimes {
  std::string name;
  double compute_s = 0.0, messaging_s = 0.0, waiting_s = 0.0;
  double start_s = 0.0;  // from the start of the process until it was ready
  std::uint64_t peak_resident_bytes = 0, private_bytes = 0;
  std::vector<std::string> topics;  // that it subscribed to
};

/// How a run ended.
struct RunOutcome {
  std::string status = "complete";  // complete | interrupted | failed
  std::string how;                  // "one process" or "a process per node"
  std::string reason;               // of a failure
  double wall_s = 0.0;
  std::vector<NodeTimes> nodes;
};

/// Writes run.json: what ran, seed, digests, plan, time per effect and frame. The only product with
/// wall-clock values, besides the sensors' cost.jsonl that it summarises.
void write_run_record(const RunDirectory& directory, const Scenario& scenario,
                      const RunOutcome& outcome);

/// Writes index.html, the report of the run; says so if it can't be written. `pixels`: as in
/// `write_report`.
void write_index_page(const RunDirectory& directory, bool pixels = true);
bool has_index_page(const RunDirectory& directory);

/// Suggests what to open: the first marked picture and the index page, if they exist.
std::string what_to_open(const RunDirectory& directory, const Scenario& scenario);

/// The table at the end of a run and what to open.
std::string summary_text(const RunDirectory& directory, const Scenario& scenario,
                         const RunOutcome& outcome);

}  // namespace dmise
