#pragma once
#include "core/config/yaml/section.h"
#include "core/orbit/debris/debris_population.h"

namespace dmise {

class YamlValue;

/// Reads the mapping `population`, of which the objects begin at `start`; name and numbers are the
/// caller's. Throws `ConfigError` `file:line:column: key: reason`.
DebrisPopulation read_population(const YamlValue& value, const Utc& start);

/// The keys of `population`.
const Section& population_section();

}  // namespace dmise
