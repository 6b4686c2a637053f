#pragma once
#include <cstdint>
#include <string>

#include "core/config/scenario.h"
#include "core/detection/described_sources.h"
#include "core/sim/exposure_observer.h"

namespace dmise {

/// A sensor in a recorded run of the same scenario.
struct RecordedSensor {
  const Scenario& scenario;
  const std::string& sensor;
  std::uint32_t frames = 0;   // that the recording must have, from the first; others end the run
  const std::string& digest;  // digest of the scenario
  const std::string& path;    // where the recording is
};

/// Finds in the frames of a sensor what its detector has found in the recorded run. Throws
/// `ConfigError` "PATH: reason" for a file that is no such recording.
SourceFinder recorded_finder(const RecordedSensor& recorded);

/// Gives a sensor that is a program its products of the recorded run. Throws as `recorded_finder`.
ExposureObserver recorded_observer(const RecordedSensor& recorded);

}  // namespace dmise
