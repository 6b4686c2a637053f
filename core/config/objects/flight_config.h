#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/config/yaml/section.h"
#include "core/forces/flight_forces.h"
#include "core/forces/manoeuvre.h"
#include "core/orbit/elements/elements.h"
#include "core/orbit/motion.h"
#include "core/time/julian_date.h"

namespace dmise {

class YamlMap;

/// How an object flies by numerical integration: from the state at its epoch, or from its first
/// manoeuvre on.
struct FlightConfig {
  bool numerical = false;  // from the epoch of a state, a `TwoBodyMotion`
  FlightForceSettings forces;
  std::vector<Manoeuvre> manoeuvres;  // from the start of the run; in order
  std::string where;                  // `file:line:column: objects[0].motion`, for messages
  // What the scenario says of the motion; `MotionConfig::model` is what has become of it.
  std::variant<MotionModel, MeanElements> stated = {};
  std::string end = {};  // why it ends within the run: "it enters the Earth"; empty: it does not
};

/// Reads `forces` and `manoeuvres` of a motion; empty if it has neither and is not `numerical`.
/// `start`: of the run. Throws `ConfigError` `file:line:column: key: reason`.
std::optional<FlightConfig> read_flight(YamlMap& motion, bool numerical, const Utc& start);

const Section& forces_section();
const Section& manoeuvre_section();

class JsonWriter;
/// Writes what determines the states, but for the stated motion.
void write_flight(JsonWriter& json, const FlightConfig& flight);

}  // namespace dmise
