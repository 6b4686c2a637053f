#pragma once
#include "core/config/scenario.h"
#include "launch/run/run_directory.h"

namespace dmise {

/// The parts in which a run was made before it goes on.
struct EarlierParts {
  int count = 0;
  double wall_s = 0.0;
};

/// Reads what run.json says of the part before and those before it. A part that was killed could
/// not say how long it took: it counts until the last frame of a sensor.
EarlierParts earlier_parts(const Scenario& scenario, const RunDirectory& directory);

/// Reads the mark of a run that has begun: the number of parts with this one, and the time of those
/// before.
EarlierParts parts_begun(const RunDirectory& directory);

/// Writes run.json with the digest of the run, so that it can be recognised if interrupted, and
/// the parts before.
void mark_begun(const RunDirectory& directory, const EarlierParts& earlier);

/// Writes in run.json that the run has failed and why, where there may be no room for its record:
/// in the place of what `mark_begun` wrote.
void mark_failed(const RunDirectory& directory, const std::string& reason);

/// First tick that a run must perform, given products in `directory` of a run of the same digest:
/// that of the first unfinished frame of any sensor. 0: from the start.
Tick resume_tick(const Scenario& scenario, const RunDirectory& directory);

}  // namespace dmise
