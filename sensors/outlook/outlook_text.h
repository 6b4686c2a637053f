#pragma once
#include <string>
#include <vector>

#include "core/base/json.h"
#include "sensors/outlook/sensor_outlook.h"

namespace dmise {

/// What of an outlook is probably not meant: one line each, beginning with `where`.
std::vector<std::string> warnings_of(const SensorOutlook& outlook, const std::string& where);

/// A few lines for people, each beginning with the sensor's name.
std::vector<std::string> lines_of(const SensorOutlook& outlook);

/// One line for people, without the name: field, scale, limits, Sun and Moon.
std::string short_text(const SensorOutlook& outlook);

/// For machines: angles in degrees, magnitudes V; frames with their UTC.
void write_json(JsonWriter& json, const SensorOutlook& outlook, const Clock& clock);

}  // namespace dmise
