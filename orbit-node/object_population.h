#pragma once
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "core/orbit/attitude.h"
#include "core/orbit/elements.h"
#include "core/orbit/motion.h"
#include "core/sim/state.h"
#include "core/time/clock.h"

namespace dmise {

struct ObjectAttitude {
  std::size_t object = 0;  // index in the roster
  Attitude model;
};

/// Objects of a scenario: properties, motion models and attitudes. The roster holds objects moved
/// by SGP4 first, those of catalogues before the scenario's, then those of other models: object i
/// has `elements[i]` or `models[i - elements.size()]`.
struct ObjectPopulation {
  ObjectRoster roster;
  std::vector<MeanElements> elements;
  std::vector<MotionModel> models;
  std::vector<ObjectAttitude> attitudes;  // by ascending index
  std::vector<std::string> notes;  // one line each: records refused, stale elements, short spans
};

/// Reads the scenario's catalogues. An object in several catalogues is taken from the first; an
/// object of the scenario replaces a catalogue's object of its number. Throws `ConfigError` if
/// `only` names a missing object, if a trajectory or an attitude does not overlap the run, or if it
/// ends during the run and a sensor depends on it.
ObjectPopulation load_objects(const Scenario& scenario, const Clock& clock);

}  // namespace dmise
