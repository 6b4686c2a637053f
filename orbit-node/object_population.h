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

/// The objects of a scenario: their facts, what moves them, how they stand. The roster holds those
/// that SGP4 moves, catalogues' first, then those of the other models: object i has `elements[i]`
/// or `models[i - elements.size()]`.
struct ObjectPopulation {
  ObjectRoster roster;
  std::vector<MeanElements> elements;
  std::vector<MotionModel> models;
  std::vector<ObjectAttitude> attitudes;  // by ascending index
  std::vector<std::string> notes;  // one line each: records refused, stale elements, short spans
};

/// Reads the scenario's catalogues. An object named by several keeps its first; one of the
/// scenario's own takes the place of a catalogue's with its number. Throws `ConfigError` if `only`
/// names an object that is not there, if a trajectory or an attitude has nothing to do with the
/// time of the run, or if it ends within and a sensor depends on it.
ObjectPopulation load_objects(const Scenario& scenario, const Clock& clock);

}  // namespace dmise
