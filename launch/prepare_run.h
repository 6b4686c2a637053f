#pragma once
#include <string>

#include "launch/run_directory.h"
#include "launch/run_record.h"

namespace dmise {

/// What a run finds to do.
struct RunStart {
  bool needed = true;   // false: the same run is complete (said on stdout)
  Tick first_tick = 0;  // > 0: an earlier run of the same was cut short here
};

/// Decides what a run does with its directory: goes on with the same run if it was cut short, else
/// clears it. Throws `ConfigError` when another run is there and `force` is off.
RunStart prepare_directory(RunDirectory& directory, const Scenario& scenario, bool force);

/// Merges the lines, writes run.json and index.html and prints the summary; throws `ExitWith` or
/// the failure itself unless the run is complete.
void finish_run(const RunDirectory& directory, const Scenario& scenario, RunOutcome outcome);

/// Exit code that a status stands for: complete 0, interrupted 130, failed 1.
int exit_code(const std::string& status);

}  // namespace dmise
