#pragma once
#include "core/base/files/json.h"
#include "core/config/yaml/section.h"
#include "core/optics/thermal_optics.h"

namespace dmise {

class YamlValue;

/// Reads `emission:` of a camera's optics.
ThermalOptics read_thermal_optics(const YamlValue& value);

/// Throws `ConfigError` at `camera` if optics aboard an object lack a temperature, which on the
/// ground is the air's.
void check_warm_in_space(const YamlValue& camera, const ThermalOptics& optics);

const Section& thermal_optics_section();

/// Writes them for the digest, if there are any.
void write_thermal_optics_json(JsonWriter& json, const ThermalOptics& optics);

}  // namespace dmise
