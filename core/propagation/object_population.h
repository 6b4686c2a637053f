#pragma once
#include <set>
#include <string>
#include <vector>

#include "core/config/objects/object_config.h"
#include "core/orbit/attitude.h"
#include "core/orbit/elements/elements.h"
#include "core/orbit/motion.h"
#include "core/sim/state.h"

namespace dmise {

struct ObjectAttitude {
  std::size_t object = 0;  // index in the roster
  Attitude model;
};

/// Objects of a scenario: properties, motion models and attitudes. The roster holds objects moved
/// by SGP4 first, those of catalogues before the scenario's, then those of other models: object i
/// has `elements[i]` or `models[i - elements.size()]`.
struct ObjectPopulation {
  ObjectRoster roster;  // without elements
  std::vector<MeanElements> elements;
  std::vector<MotionModel> models;
  std::vector<ObjectAttitude> attitudes;  // by ascending index
  Ellipsoid ellipsoid{};                  // no object moves below it
  std::vector<std::string> notes;  // one line each: records refused, stale elements, short spans
};

/// Returns the roster as it is published, with the element sets.
ObjectRoster published_roster(const ObjectPopulation& population);

/// Returns the population of a published roster: element sets are the roster's, other motions and
/// all attitudes those of the scenario's own objects and of `models`. Throws `Error` if the roster
/// is not one of a scenario with these objects.
ObjectPopulation population_of(const ObjectRoster& roster, const std::vector<OwnObject>& own,
                               const Ellipsoid& ellipsoid = wgs84, const ObjectModels& models = {});

/// The subset of a population. `indices` ascend.
ObjectPopulation only_these(const ObjectPopulation& all, const std::set<std::size_t>& indices);

}  // namespace dmise
