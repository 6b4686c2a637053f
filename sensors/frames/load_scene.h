#pragma once
#include <memory>

#include "orbit-node/load_objects.h"
#include "sensors/frame/make_sensor.h"

namespace dmise {

/// Inputs that a run reads before its first frame. All errors in them are reported before the run's
/// directory is touched.
struct ScenarioInputs {
  ObjectPopulation population;
  std::shared_ptr<const StarMap> stars;  // null: none
};

/// Throws `ConfigError` with the position of the invalid key.
inline ScenarioInputs load_scene(const Scenario& scenario, const Clock& clock) {
  ScenarioInputs scene{.population = load_objects(scenario, clock), .stars = nullptr};
  check_sensors(scenario, scene.population.roster);
  scene.stars = load_stars(scenario);
  return scene;
}

}  // namespace dmise
