#pragma once
#include <string>

#include "launch/run_directory.h"
#include "launch/run_record.h"

namespace dmise {

/// Decides what a run does with its directory. True: go on, the directory is clear. False: the same
/// run is complete there and there is nothing to do (said on stdout). Throws `ConfigError` when
/// another run is there and `force` is off.
bool prepare_directory(RunDirectory& directory, bool force);

/// Merges the lines, writes run.json and index.html and prints the summary; throws `ExitWith` or
/// the failure itself unless the run is complete.
void finish_run(const RunDirectory& directory, const Scenario& scenario, const RunOutcome& outcome);

/// Exit code that a status stands for: complete 0, interrupted 130, failed 1.
int exit_code(const std::string& status);

}  // namespace dmise
