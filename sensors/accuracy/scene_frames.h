#pragma once
#include <memory>

#include "sensors/frame/frame_pipeline.h"

namespace dmise {

/// One exposure of a scenario's sensor, to be made in many ways.
class SceneFrames {
 public:
  /// `sensor`: its name. Throws `ConfigError` for one that does not exist and for a frame that does
  /// not end within the run. `threads` must outlive it.
  SceneFrames(const Scenario& scenario, const std::string& sensor, std::uint32_t frame,
              Threads& threads);

  const Scenario& scenario() const { return scenario_; }
  const SensorConfig& sensor() const { return sensor_named(scenario_, name_); }
  const FrameTimes& times() const { return times_; }
  const StateWindow& states() const { return window_; }
  const std::shared_ptr<const StarMap>& stars() const { return stars_; }
  Exposure exposure() const;
  Threads& threads() const { return threads_; }

  /// Returns the chain of a sensor that differs from the scenario's in its effects and accuracy.
  /// With `planes`: it gives light and true stars too.
  std::unique_ptr<FramePipeline> pipeline(const SensorConfig& as, bool planes) const;
  /// Whether a chain can make the frame more than once: not if the detector keeps charge in traps.
  bool can_repeat() const { return !(sensor().camera.detector.persistence_fraction > 0.0); }
  /// Makes the frame by a new chain, with its light and true stars.
  FrameProducts make(const SensorConfig& as) const;

 private:
  Scenario scenario_;
  std::string name_;
  FrameTimes times_;
  Threads& threads_;
  StateWindow window_;
  std::shared_ptr<const StarMap> stars_;
};

}  // namespace dmise
