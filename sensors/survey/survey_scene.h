#pragma once
#include <memory>
#include <vector>

#include "core/config/scenario.h"
#include "core/propagation/object_states.h"
#include "core/sim/state.h"
#include "core/sky/stars/star_cache.h"
#include "core/time/clock.h"
#include "core/visibility/ephemeris_table.h"
#include "sensors/survey/detection_model.h"

namespace dmise {

/// What the surveys of all sensors of a scenario share. The scenario and the population must
/// outlive it. Immutable.
class SurveyScene {
 public:
  /// `stars` may be null. Throws `Error` for a run outside the ephemerides.
  SurveyScene(const Scenario& scenario, const ObjectPopulation& population, const Clock& clock,
              std::shared_ptr<const StarMap> stars, Threads& threads,
              const DetectionModel& model = measured_detection_model());

  const Scenario& scenario() const { return scenario_; }
  const ObjectPopulation& population() const { return source_.population(); }
  const StateSource& source() const { return source_; }
  const Clock& clock() const { return source_.clock(); }
  const EphemerisTable& hours() const { return hours_; }
  const DetectionModel& model() const { return model_; }
  const std::shared_ptr<const ObjectRoster>& roster() const { return roster_; }
  const std::shared_ptr<const StarMap>& stars() const { return stars_; }

  /// Sun, Moon and Earth as last known at or before `t`.
  const std::shared_ptr<const EnvironmentState>& environment(SimTime t) const;

 private:
  const Scenario& scenario_;
  StateSource source_;
  EphemerisTable hours_;
  std::shared_ptr<const ObjectRoster> roster_;
  std::shared_ptr<const StarMap> stars_;
  DetectionModel model_;
  std::vector<std::shared_ptr<const EnvironmentState>> environment_;
};

}  // namespace dmise
