#pragma once
#include "core/config/sensors/sensor_settings.h"
#include "core/config/yaml/section.h"

namespace dmise {

class YamlValue;

/// Reads `effects:` of a scenario or a sensor and applies it to `effects`. Throws `ConfigError`.
void read_effects(const YamlValue& value, EffectSet& effects);

/// Reads `accuracy:` of a scenario or a sensor. Throws `ConfigError`.
Accuracy read_accuracy(const YamlValue& value);

// Forms for the tables of scenarios and sensors.
Forms effects_forms();
Forms accuracy_forms();

}  // namespace dmise
