#pragma once
#include "core/config/scenario.h"
#include "core/config/yaml_reader.h"

namespace dmise {

/// Reads `pointing:` of a sensor with `tracking` and `roll_deg` in it. Throws `ConfigError`.
void read_pointing(const YamlValue& value, bool on_ground, SensorConfig& sensor);

/// How fast a pointing moves by itself [deg/s]; 0 for one that stands or follows something.
double turn_rate_deg_per_s(const Pointing& pointing);

class JsonWriter;
/// What of it decides the products.
void write_pointing(JsonWriter& json, const Pointing& pointing);

}  // namespace dmise
