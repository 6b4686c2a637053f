#include "sensors/survey/survey_scene.h"

#include <algorithm>
#include <variant>

#include "nodes/environment/environment_actor.h"

namespace dmise {
namespace {

/// Sun, Moon and Earth run on from such times: to 0.01 arcsec.
const SimTime environment_every = sim_seconds(600.0);

/// A scenario of nothing but the common environment.
Scenario environment_alone() {
  Scenario one;
  one.tick = environment_every;
  one.environment = {.common_every_s = 0.0};
  one.network.sensors_propagate = false;
  return one;
}

}  // namespace

SurveyScene::SurveyScene(const Scenario& scenario, const ObjectPopulation& population,
                         const Clock& clock, std::shared_ptr<const StarMap> stars, Threads& threads,
                         const DetectionModel& model)
    : scenario_(scenario),
      source_(population, clock, threads),
      hours_(clock, {0}, scenario.duration, scenario.earth.ellipsoid),
      roster_(std::make_shared<const ObjectRoster>(population.roster)),
      stars_(std::move(stars)),
      model_(model) {
  EnvironmentActor actor(environment_alone(), clock);
  const Tick last = scenario.duration.ns / environment_every.ns + 1;
  for (Tick tick = 0; tick <= last; ++tick)
    for (const auto& message : actor.step(tick, {}))
      if (const auto* state = std::get_if<EnvironmentState>(message.state.get()))
        environment_.push_back(std::shared_ptr<const EnvironmentState>(message.state, state));
}

const std::shared_ptr<const EnvironmentState>& SurveyScene::environment(SimTime t) const {
  const auto tick = std::max<std::int64_t>(0, t.ns / environment_every.ns);
  return environment_[std::min(std::size_t(tick), environment_.size() - 1)];
}

}  // namespace dmise
