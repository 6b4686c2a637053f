#pragma once
#include <cstddef>
#include <vector>

#include "core/plan/planner.h"
#include "sensors/objects/object_shapes.h"
#include "sensors/planning/star_facts.h"
#include "sensors/scene/view.h"

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
  /// run that is replayed, if the sensor has recorded plans. Without an accuracy it has the effects
  /// alone: `asked_effects`. Throws `Error` naming what of a
  /// recorded plan does not fit the sensor.
  EffectPlan plan(const View& view, const std::vector<std::size_t>& objects) const;

  /// Effects as the scenario asks for them, with synthetic stars to the limit of this frame where
  /// that is asked for.
  EffectSet asked_effects(const View& view) const;

 private:
  void set_frame_limit(const PlanFacts& known, EffectSet& effects) const;
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
