#include "sensors/survey/survey_scene.h"

#include <algorithm>

#include "core/propagation/environment_source.h"

namespace dmise {
namespace {

/// Sun, Moon and Earth run on from such times: to 0.01 arcsec.
const SimTime environment_every = sim_seconds(600.0);

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
  const Tick last = scenario.duration.ns / environment_every.ns + 1;
  for (Tick tick = 0; tick <= last; ++tick)
    environment_.push_back(std::make_shared<const EnvironmentState>(
        environment_at(clock, tick, {tick * environment_every.ns})));
}

const std::shared_ptr<const EnvironmentState>& SurveyScene::environment(SimTime t) const {
  const auto tick = std::max<std::int64_t>(0, t.ns / environment_every.ns);
  return environment_[std::min(std::size_t(tick), environment_.size() - 1)];
}

}  // namespace dmise
