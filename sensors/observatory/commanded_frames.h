#pragma once
#include <map>
#include <memory>
#include <string>

#include "sensors/frame/make_sensor.h"
#include "sensors/frame/product_writer.h"
#include "sensors/frames/load_scene.h"
#include "sensors/objects/state_window_source.h"
#include "sensors/observatory/commanded_exposure.h"

namespace dmise {

/// Throws `ConfigError` for a scenario whose sensors cannot be commanded: none is a camera on the
/// ground, or it needs programs of the user's.
void check_observatory(const Scenario& scenario);

/// Cameras of the scenario that can be commanded: those on the ground.
std::vector<SensorConfig> commanded_sensors(const Scenario& scenario);

/// Makes and writes the frames of one sensor as it is commanded. A frame depends on its exposure
/// and the scenario alone.
class CommandedFrames {
 public:
  /// `scenario` and `scene` must outlive it. `directory`: of the run; the sensor writes into its
  /// own below it.
  CommandedFrames(const Scenario& scenario, const ScenarioInputs& scene, const std::string& sensor,
                  const std::string& digest, const std::string& directory, int threads);

  FrameProducts make(const CommandedExposure& exposure);
  void write(const FrameProducts& frame) { writer_.write(frame); }

 private:
  const PipelineSettings& settings_of(int filter);

  Threads threads_;
  const Scenario& scenario_;
  std::string sensor_, digest_;
  std::map<int, PipelineSettings> settings_;  // by filter, from its first frame on
  Clock clock_;
  std::shared_ptr<const StarMap> stars_;
  const ObjectPopulation& population_;
  StateWindowSource windows_;
  StateSource states_;
  ProductWriter writer_;
};

}  // namespace dmise
