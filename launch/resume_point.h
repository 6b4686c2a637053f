#pragma once
#include "core/config/scenario.h"
#include "launch/run_directory.h"

namespace dmise {

/// Writes run.json with the digest of the run, so that it can be recognised if interrupted.
void mark_begun(const RunDirectory& directory);

/// First tick that a run must perform, given products in `directory` of a run of the same digest:
/// that of the first unfinished frame of any sensor. 0: from the start.
Tick resume_tick(const Scenario& scenario, const RunDirectory& directory);

}  // namespace dmise
