#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/propagation/object_states.h"
#include "core/time/clock.h"
#include "sensors/forecast/camera_figures.h"
#include "sensors/forecast/frame_forecast.h"
#include "sensors/scene/exclusion.h"

namespace dmise {

/// Frames in which a body is nearer to the axis than the camera allows.
struct ExcludedFrames {
  const ExcludingBody* body = nullptr;
  double limit_deg = 0.0;
  std::uint32_t count = 0, first = 0, last = 0;
  SimTime first_middle, last_middle;
  std::optional<double> min_rad;  // over all frames looked at
};

/// Prediction of a sensor's frames from a few of them, without rendering.
struct SensorForecast {
  std::string sensor;
  CameraFigures camera;
  bool on_ground = true;
  std::string target;   // what the pointing follows; empty: nothing
  bool cued = false;    // examined as it is parked
  std::string by_node;  // node that moves its platform or target: not examined
  double min_limb_angle_rad = 0.0;
  std::uint32_t frames_in_run = 0;
  ExclusionAction exclusion_action = ExclusionAction::flag;
  std::uint32_t looked_for_exclusion = 0;  // frames examined: all, or evenly spaced ones
  std::uint32_t excluded_frames = 0;       // in which at least one body is too near
  std::vector<ExcludedFrames> excluded;    // one per body that the camera has a limit for
  bool objects_counted = true;             // false: too many objects
  std::vector<FrameForecast> frames;       // examined: the first, the last, and evenly spaced ones
  std::optional<FrameForecast> mid_run;    // the frame in the middle of the run, for its limits
  std::vector<std::string> warnings;       // one line each, with the sensor's place in the scenario
};

struct ForecastOptions {
  std::uint32_t max_frames = 16;  // examined; 0: only the one in mid run
  /// Number of object states computed for counting: beyond, fewer frames are examined, and if two
  /// are too many, objects are not counted.
  std::size_t max_states = 4'000'000;
  /// Frames of sensors in orbit whose boresight is nearer to the Earth's limb are warned of.
  double min_limb_angle_rad = 0.0;
};

/// Examines frames of `sensor`, one of the scenario's. `stars` may be null. Throws `ConfigError`
/// with the key's position if its platform or target has no state at the first frame, as the run
/// would.
SensorForecast sensor_forecast(const Scenario& scenario, const SensorConfig& sensor,
                               const ObjectPopulation& population, const Clock& clock,
                               std::shared_ptr<const StarMap> stars, Threads& threads,
                               const ForecastOptions& options = {});

/// Warnings of catalogues whose elements are weeks from the start of the run.
std::vector<std::string> catalogue_warnings(const Scenario& scenario,
                                            const ObjectPopulation& population);

/// Age [days] beyond which positions from an element set are off by kilometres.
inline constexpr double old_after_days = 14.0;

}  // namespace dmise
