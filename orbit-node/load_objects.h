#pragma once
#include "core/config/scenario.h"
#include "core/propagation/object_population.h"
#include "core/time/clock.h"

namespace dmise {

/// Reads the scenario's catalogues and makes its constellations. An object in several catalogues is
/// taken from the first; an object of the scenario replaces a catalogue's object of its number.
/// Throws `ConfigError` if `only` names a missing object, if a trajectory or an attitude does not
/// overlap the run, or if it ends during the run and a sensor depends on it.
ObjectPopulation load_objects(const Scenario& scenario, const Clock& clock);

}  // namespace dmise
