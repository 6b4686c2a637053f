#pragma once
#include <cstdint>
#include <string>

#include "core/config/scenario.h"
#include "core/detection/described_sources.h"

namespace dmise {

/// Finds in the frames of a sensor what its detector has found in a recorded run of the same
/// scenario. `frames`: that the recording must have, from the first; those that it lacks beyond end
/// the run. `digest`: of the scenario. Throws `ConfigError` "PATH: reason" for a file that is no
/// such recording.
SourceFinder recorded_finder(const Scenario& scenario, const std::string& sensor,
                             std::uint32_t frames, const std::string& digest,
                             const std::string& path);

}  // namespace dmise
