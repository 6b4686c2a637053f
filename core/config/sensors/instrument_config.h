#pragma once
#include "core/config/sensors/sensor_settings.h"
#include "core/config/yaml/section.h"

namespace dmise {

class YamlMap;
class YamlValue;
class JsonWriter;

/// Reads `clock_error` and `pointing_error` of a sensor.
void read_instrument(YamlMap& sensor, Instrument& instrument);

/// Throws `ConfigError` if by its clock a sensor's first exposure may begin before the run or end
/// after it. `map`: the keys of the sensor.
void check_clock(YamlMap& map, const SensorConfig& sensor, SimTime duration);

/// Writes the errors that are not 0, for digests.
void write_instrument_json(JsonWriter& json, const Instrument& instrument);

/// Returns the numbers of a parameter in the unit of its key: one, or x, y and roll.
std::vector<double> numbers_of(const InstrumentParameter& parameter, const Instrument& instrument);

/// The keys of these effects, for the section of a sensor.
std::vector<Key> instrument_keys();

const Section& malfunction_section();
std::vector<Malfunction> read_malfunctions(const YamlValue& list);

}  // namespace dmise
