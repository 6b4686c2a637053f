#include "launch/prepare_run.h"

#include <cstdio>

#include "core/base/error.h"
#include "launch/commands.h"
#include "launch/resume_point.h"

namespace dmise {

RunStart prepare_directory(RunDirectory& directory, const Scenario& scenario, bool force) {
  using Content = RunDirectory::Content;
  const Content content = force ? Content::empty : directory.content();
  if (content == Content::same_run_complete) {
    std::printf("%s contains this run, complete; --force repeats it\n", directory.path().c_str());
    if (!has_index_page(directory)) write_index_page(directory);
    std::fputs(what_to_open(directory, scenario).c_str(), stdout);
    return {.needed = false};
  }
  if (content == Content::another_run)
    throw ConfigError(
        directory.path() +
        ": contains the products of another run; --force replaces them, --out writes elsewhere");
  RunStart start;
  if (content == Content::same_run_unfinished) start.first_tick = resume_tick(scenario, directory);
  if (start.first_tick > 0) {
    std::printf(
        "%s contains this run, interrupted: continuing at tick %ld of %ld; --force restarts\n",
        directory.path().c_str(), long(start.first_tick), long(scenario.last_tick()));
    std::fflush(stdout);
  } else {
    directory.clear();
  }
  mark_begun(directory);
  return start;
}

void finish_run(const RunDirectory& directory, const Scenario& scenario, RunOutcome outcome) {
  try {
    directory.merge_lines();
    write_run_record(directory, scenario, outcome);  // the last product, for it marks completion
    write_index_page(directory, outcome.status != "interrupted");  // which ends at once
  } catch (const Error& error) {
    // Report the first error; if that was a full disk, this one is a consequence.
    if (outcome.status != "failed") outcome.reason = error.what();
    outcome.status = "failed";
  }
  std::fputs(summary_text(directory, scenario, outcome).c_str(), stdout);
  if (outcome.status == "failed") throw Error(outcome.reason);
  if (const int code = exit_code(outcome.status)) throw ExitWith{code};
}

int exit_code(const std::string& status) {
  return status == "complete" ? 0 : status == "interrupted" ? 130 : 1;
}

}  // namespace dmise
