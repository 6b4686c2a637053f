#pragma once
#include <string>

#include "core/config/yaml/section.h"
#include "core/forces/proximity.h"

namespace dmise {

class JsonWriter;
class YamlValue;

/// How an object moves near another, its chief.
struct ProximityConfig {
  std::string chief;  // name or number of an object of the scenario
  ProximityMotion motion;
  std::string where;        // `file:line:column: objects[0].motion.proximity`, for messages
  std::string chief_where;  // place of `of`
};

/// Reads `proximity`. Throws `ConfigError` `file:line:column: key: reason`.
ProximityConfig read_proximity(const YamlValue& value);

const Section& proximity_section();

/// Writes what determines the relative motion.
void write_proximity(JsonWriter& json, const ProximityConfig& proximity);

}  // namespace dmise
