#pragma once
#include "core/propagation/object_population.h"
#include "core/propagation/object_states.h"
#include "sensors/objects/state_window_source.h"
#include "sensors/observatory/satellite_path.h"
#include "sensors/observatory/site_conditions.h"
#include "sensors/observatory/site_sky.h"
#include "sensors/scene/view.h"

namespace dmise {

/// The sky of a scenario over one of its sensors on the ground, as its frames have it. Calls may
/// run concurrently.
class ScenarioSky : public SiteSky {
 public:
  /// `scenario` and `sensor` must outlive it.
  ScenarioSky(const Scenario& scenario, const SensorConfig& sensor, const Clock& clock);

  Vec<Enu> seen(const Equatorial& icrs, SimTime t) const override;
  Equatorial star_seen_at(const Vec<Enu>& direction, SimTime t) const override;
  Vec<Gcrs> gcrs(const Vec<Enu>& direction, SimTime t) const override;
  double sidereal_time_rad(SimTime t) const override;
  SiteConditions conditions(SimTime t) const;
  /// The path of a satellite over the sensor. The sky must outlive it.
  std::shared_ptr<const SatellitePath> path_of(const MeanElements& elements) const;

 private:
  template <class Ask>
  auto ask(SimTime t, const Ask& ask) const;

  const Scenario& scenario_;
  SensorConfig sensor_;
  Clock clock_;
  StateWindowSource windows_;
  ObjectPopulation nothing_;  // objects do not matter
  mutable Threads threads_;
  StateSource states_;
};

}  // namespace dmise
