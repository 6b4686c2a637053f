#pragma once
#include <string>

#include "launch/run/run_directory.h"
#include "launch/run/run_outcome.h"

namespace dmise {

/// How a run starts in its directory.
struct RunStart {
  bool needed = true;   // false: the same run is complete (printed)
  Tick first_tick = 0;  // > 0: continues an interrupted run
};

/// Prepares the directory of a run: continues an unfinished run, or clears it. Throws
/// `ConfigError` if another run is there, or files that may not be of a run, and `force` is off.
RunStart prepare_directory(RunDirectory& directory, const Scenario& scenario, bool force);

/// Merges the lines, writes run.json and index.html and prints the summary; throws `ExitWith` or
/// the failure itself if the run was interrupted or failed.
void finish_run(const RunDirectory& directory, const Scenario& scenario, RunOutcome outcome);

/// Exit code of a status: interrupted 130, failed 1, others 0.
int exit_code(const std::string& status);

}  // namespace dmise
