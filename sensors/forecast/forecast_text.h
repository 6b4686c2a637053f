#pragma once
#include <string>
#include <vector>

#include "core/base/files/json.h"
#include "sensors/forecast/sensor_forecast.h"

namespace dmise {

/// Warnings of an forecast, one line each, beginning with `where`.
std::vector<std::string> warnings_of(const SensorForecast& forecast, const std::string& where);

/// "limiting magnitude V = 12.34", as `check` and `explain` print it; empty where there is none.
std::string limiting_magnitude_text(const SensorForecast& forecast);
/// Its definition in words.
std::string limiting_magnitude_meaning();

/// A few lines of text, each beginning with the sensor's name.
std::vector<std::string> lines_of(const SensorForecast& forecast);

/// One line of text, without the name: field, scale, limits, Sun and Moon.
std::string short_text(const SensorForecast& forecast);

/// JSON: angles in degrees, magnitudes V; frames with their UTC.
void write_json(JsonWriter& json, const SensorForecast& forecast, const Clock& clock);

}  // namespace dmise
