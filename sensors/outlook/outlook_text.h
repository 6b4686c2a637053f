#pragma once
#include <string>
#include <vector>

#include "core/base/files/json.h"
#include "sensors/outlook/sensor_outlook.h"

namespace dmise {

/// Warnings of an outlook, one line each, beginning with `where`.
std::vector<std::string> warnings_of(const SensorOutlook& outlook, const std::string& where);

/// "limiting magnitude V = 12.34", as `check` and `explain` print it; empty where there is none.
std::string limiting_magnitude_text(const SensorOutlook& outlook);
/// Its definition in words.
std::string limiting_magnitude_meaning();

/// A few lines of text, each beginning with the sensor's name.
std::vector<std::string> lines_of(const SensorOutlook& outlook);

/// One line of text, without the name: field, scale, limits, Sun and Moon.
std::string short_text(const SensorOutlook& outlook);

/// JSON: angles in degrees, magnitudes V; frames with their UTC.
void write_json(JsonWriter& json, const SensorOutlook& outlook, const Clock& clock);

}  // namespace dmise
