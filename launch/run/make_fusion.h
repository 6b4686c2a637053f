#pragma once
#include <memory>
#include <string>

#include "core/config/scenario.h"
#include "core/sim/participant.h"
#include "core/time/clock.h"
#include "nodes/own/own_node_run.h"

namespace dmise {

class Tracker;

// A program without fusion has these as well; they throw `Error` there.

/// Returns the participant that tracks objects. `recorded`: in place of the scenario's tracker;
/// null: none.
std::unique_ptr<Participant> make_fusion(const Scenario& scenario, const Clock& clock,
                                         const std::string& directory,
                                         const OwnNodeSettings& settings,
                                         const std::shared_ptr<Tracker>& recorded);
/// Returns what a tracker has said in a recorded run. Throws `ConfigError` as `RecordedTracker`.
std::shared_ptr<Tracker> make_recorded_tracker(const Scenario& scenario, const std::string& digest,
                                               const std::string& path);

}  // namespace dmise
