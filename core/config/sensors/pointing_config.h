#pragma once
#include "core/config/sensors/sensor_settings.h"
#include "core/config/yaml/section.h"

namespace dmise {

class YamlValue;

/// Reads `pointing:` of a sensor, including `tracking` and `roll_deg`; `origin` is the scenario's.
/// Throws `ConfigError`.
void read_pointing(const YamlValue& value, bool on_ground, SensorConfig& sensor,
                   const std::optional<Site>& origin = std::nullopt);

/// Angular rate of a pointing [deg/s]; 0 if it is fixed or follows a target.
double turn_rate_deg_per_s(const Pointing& pointing);

class JsonWriter;
/// Writes the part that determines the products.
void write_pointing(JsonWriter& json, const Pointing& pointing);

/// The forms of `pointing`.
Forms pointing_forms();

}  // namespace dmise
