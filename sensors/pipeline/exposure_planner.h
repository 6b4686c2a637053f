#pragma once
#include <cstddef>
#include <vector>

#include "core/plan/planner.h"
#include "sensors/pipeline/object_shapes.h"
#include "sensors/pipeline/star_facts.h"
#include "sensors/pipeline/view.h"

namespace dmise {

/// Plans the effects of one sensor's exposures.
class ExposurePlanner {
 public:
  /// `sensor`, `stars` and `shapes` must outlive it. `stars`, `shapes`: null for none.
  ExposurePlanner(const SensorConfig& sensor, const StarMap* stars, double faintest_star_mag,
                  const ObjectShapes* shapes);

  /// What is known of an exposure before it is made. `view`: of the sensor as it was asked for;
  /// `objects`: those in its field.
  PlanFacts facts(const View& view, const std::vector<std::size_t>& objects) const;

  /// Returns the plan of an exposure, the same for the same arguments on any machine; that of the
  /// run that is replayed, if the sensor has recorded plans. Throws `Error` naming what of a
  /// recorded plan does not fit the sensor.
  EffectPlan plan(const View& view, const std::vector<std::size_t>& objects) const;

 private:
  void look_at_sensor();
  PlanFacts dark_facts() const;
  void look_at_objects(const View& view, const std::vector<std::size_t>& objects,
                       PlanFacts& facts) const;

  const SensorConfig& sensor_;
  const ObjectShapes* shapes_;
  StarFacts stars_;
  std::vector<PlannableEffect> effects_;
  std::vector<PlannableEffect> effects_in_the_dark_;  // behind a closed shutter
  PlanFacts of_sensor_;                               // what no exposure changes
};

}  // namespace dmise
