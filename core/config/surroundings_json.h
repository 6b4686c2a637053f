#pragma once
#include "core/base/files/json.h"
#include "core/config/scenario.h"

namespace dmise {

// JSON of the sky and atmosphere of a sensor, for `physics_json`.
void write_curve(JsonWriter& json, std::string_view key, const Curve& curve);
void write_surroundings(JsonWriter& json, const SensorConfig& sensor);

}  // namespace dmise
