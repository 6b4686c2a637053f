#pragma once
#include "core/config/sensors/sensor_settings.h"

namespace dmise {

class YamlValue;
struct Section;

/// Reads one of `sensors:`; `effects`, `accuracy` and `detect` are the scenario's, `duration` the
/// run's. Throws `ConfigError`.
SensorConfig read_sensor(const YamlValue& value, const EffectSet& effects, const Accuracy& accuracy,
                         bool detect, SimTime duration, const EarthConfig& earth = {});

// The keys of a site, of a sensor with a camera, and of one that is a program of the user's.
const Section& site_section();
const Section& sensor_section();
const Section& own_sensor_section();

}  // namespace dmise
