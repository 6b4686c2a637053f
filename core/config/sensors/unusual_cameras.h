#pragma once
#include <string>
#include <vector>

#include "core/config/sensors/sensor_settings.h"

namespace dmise {

class YamlValue;

/// Warnings of values that a model can compute with but no telescope has, mostly wrong units, in
/// the mapping `camera`, parsed into `read`. Each line is `file:line:column: key: reason, got
/// value`; empty: all values are usual.
std::vector<std::string> unusual_camera_values(const YamlValue& camera, const Camera& read);

}  // namespace dmise
