#pragma once
#include "core/config/scenario.h"
#include "core/config/yaml_reader.h"

namespace dmise {

/// Reads `effects:` of a scenario or a sensor onto what is switched on already. Throws
/// `ConfigError`.
void read_effects(const YamlValue& value, EffectSet& effects);

/// Reads one of `sensors:`; `effects` and `detect` are those of the scenario, `duration` that of
/// the run. Throws `ConfigError`.
SensorConfig read_sensor(const YamlValue& value, const EffectSet& effects, bool detect,
                         SimTime duration);

}  // namespace dmise
