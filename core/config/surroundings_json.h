#pragma once
#include "core/base/json.h"
#include "core/config/scenario.h"

namespace dmise {

// What decides the light of the sky in a sensor's frames, as `physics_json` writes it.
void write_curve(JsonWriter& json, std::string_view key, const Curve& curve);
void write_surroundings(JsonWriter& json, const SensorConfig& sensor);

}  // namespace dmise
