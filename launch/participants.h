#pragma once
#include <memory>
#include <string>

#include "core/base/parallel.h"
#include "core/config/scenario.h"
#include "core/sim/participant.h"
#include "core/time/clock.h"
#include "sensors/pipeline/sensor_evaluator.h"

namespace dmise {

/// The scenario's clock, with its Earth orientation file.
Clock make_clock(const Scenario& scenario);

std::unique_ptr<Participant> make_orbit_actor(const Scenario& scenario, Threads& threads);
std::unique_ptr<Participant> make_environment_actor(const Scenario& scenario);
/// `directory`: of the run; the sensor writes into its own below it.
std::unique_ptr<SensorEvaluator> make_sensor(const Scenario& scenario, const std::string& name,
                                             const std::string& digest,
                                             const std::string& directory, Threads& threads);

}  // namespace dmise
