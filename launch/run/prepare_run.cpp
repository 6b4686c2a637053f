#include "launch/run/prepare_run.h"

#include <cstdio>

#include "core/base/error.h"
#include "launch/command/command.h"
#include "launch/command/notes.h"
#include "launch/run/resume_point.h"

namespace dmise {

RunStart prepare_directory(RunDirectory& directory, const Scenario& scenario, bool force) {
  using Content = RunDirectory::Content;
  directory.check_sensor_directories();
  const Content content = directory.content();
  if (!force && content == Content::same_run_complete) {
    std::printf("%s contains this run, complete; --force repeats it\n", directory.path().c_str());
    if (!has_index_page(directory)) write_index_page(directory);
    std::fputs(what_to_open(directory, scenario).c_str(), stdout);
    return {.needed = false};
  }
  if (!force && content == Content::another_run)
    throw ConfigError(
        directory.path() +
        ": contains the products of another run; --force replaces them, --out writes elsewhere");
  if (!force && content == Content::unreadable)
    throw ConfigError(directory.path() +
                      "/run.json: is not that of a run, or is damaged; --force replaces the "
                      "products, --out writes elsewhere");
  const std::string found = content == Content::no_run ? directory.in_the_way() : "";
  if (!force && !found.empty())
    throw ConfigError(
        found + ": is in the way, and no run.json in " + directory.path() +
        " says that it is of a run; --force replaces products, --out writes elsewhere");
  RunStart start;
  // Tracks that were made without a lost sensor are not those of the run with it.
  const auto anew = [&] { return scenario.fusion && directory.lacks_nodes(); };
  if (!force && content == Content::same_run_unfinished && !anew())
    start.first_tick = resume_tick(scenario, directory);
  EarlierParts earlier;
  if (start.first_tick > 0) {
    earlier = earlier_parts(scenario, directory);
    std::printf(
        "%s contains this run, unfinished: continuing at tick %ld of %ld; --force restarts\n",
        directory.path().c_str(), long(start.first_tick), long(scenario.last_tick()));
    std::fflush(stdout);
  } else if (content != Content::no_run || !found.empty()) {
    directory.clear(force);
  }
  mark_begun(directory, earlier);
  return start;
}

void finish_run(const RunDirectory& directory, const Scenario& scenario, RunOutcome outcome) {
  // Report the first error; if that was a full disk, others are consequences.
  const auto fails = [&](const Error& error) {
    if (outcome.status != "failed") outcome.reason = error.what();
    outcome.status = "failed";
  };
  try {
    directory.merge_lines();
  } catch (const Error& error) {
    fails(error);
  }
  try {
    const EarlierParts parts = parts_begun(directory);
    outcome.parts = parts.count;
    outcome.wall_s += parts.wall_s;
    write_run_record(directory, scenario, outcome);  // the last product, for it marks completion
    write_index_page(directory, outcome.status != "interrupted");  // which ends at once
  } catch (const Error& error) {
    fails(error);
    mark_failed(directory, outcome.reason);
  }
  std::fputs(summary_text(directory, scenario, outcome).c_str(), stdout);
  if (outcome.status == "failed") throw Error(outcome.reason);
  if (!outcome.reason.empty())
    print_note("the run is not complete: " + outcome.reason + "; the same command continues it");
  if (const int code = exit_code(outcome.status)) throw ExitWith{code};
}

int exit_code(const std::string& status) {
  return status == "interrupted" ? 130 : status == "failed" ? 1 : 0;
}

}  // namespace dmise
