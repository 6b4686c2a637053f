#pragma once
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "core/config/scenario.h"
#include "core/sim/message.h"

namespace dmise {

/// What was published on a topic of a recorded run.
struct RecordedState {
  std::string topic;
  Tick complete_to = -1;               // the topic has all of this tick and those before
  std::shared_ptr<const State> state;  // null: nothing, but `complete_to`
};

/// Reads what was published on `topics` in a recording (MCAP) of a run of this scenario, in the
/// order of the file, until `hear` returns false or the file ends. `digest`: of the scenario. Then
/// calls `finish`. Throws `ConfigError` "PATH: reason" for a file that is no such recording or
/// damaged, and so for what these two throw.
void read_recorded_run(const Scenario& scenario, const std::string& digest, const std::string& path,
                       const std::set<std::string>& topics,
                       const std::function<bool(const RecordedState&)>& hear,
                       const std::function<void()>& finish);

}  // namespace dmise
