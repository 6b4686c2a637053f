#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/time/clock.h"
#include "orbit-node/object_states.h"
#include "sensors/outlook/camera_figures.h"
#include "sensors/outlook/frame_outlook.h"

namespace dmise {

/// What a sensor's frames will show, from a few of them looked at without making any.
struct SensorOutlook {
  std::string sensor;
  CameraFigures camera;
  bool on_ground = true;
  std::string target;  // that it points at; empty: at none
  std::uint32_t frames_in_run = 0;
  bool objects_counted = true;        // false: too many for a look
  std::vector<FrameOutlook> frames;   // looked at: the first, the last, and evenly between
  std::vector<std::string> warnings;  // one line each, with the sensor's place in the scenario
};

struct OutlookOptions {
  std::uint32_t most_frames = 16;  // looked at
  /// States of objects worked out for counting them: beyond, fewer frames are looked at, and where
  /// two would be too many, objects are not counted.
  std::size_t most_states = 4'000'000;
};

/// Looks at frames of `sensor`, one of the scenario's. `stars` may be null. Throws `ConfigError`
/// with the key's place when its platform or target has no state at the first frame, as the run
/// would.
SensorOutlook sensor_outlook(const Scenario& scenario, const SensorConfig& sensor,
                             const ObjectPopulation& population, const Clock& clock,
                             std::shared_ptr<const StarMap> stars, Threads& threads,
                             const OutlookOptions& options = {});

/// Of a scenario's catalogues: those whose elements are weeks from the start of the run.
std::vector<std::string> catalogue_warnings(const Scenario& scenario,
                                            const ObjectPopulation& population);

/// Older than this [days], an element set's place is off by kilometres.
inline constexpr double old_after_days = 14.0;

}  // namespace dmise
