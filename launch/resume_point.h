#pragma once
#include "core/config/scenario.h"
#include "launch/run_directory.h"

namespace dmise {

/// Says in run.json which run writes here, so that it can be known again if it is cut short.
void mark_begun(const RunDirectory& directory);

/// The first tick that a run has to make which finds in `directory` what an earlier one of the same
/// digest has left: that of the first frame that any sensor has not finished. 0: from the start.
Tick resume_tick(const Scenario& scenario, const RunDirectory& directory);

}  // namespace dmise
