#pragma once
#include "core/config/sensors/sensor_settings.h"

namespace dmise {

class YamlValue;
struct Section;

/// Reads a camera: the name of a preset, a path, or the mapping itself. The keys are those of
/// launch/cameras/*.yaml.
Camera read_camera(const YamlValue& value);

/// The keys of a camera.
const Section& camera_section();

}  // namespace dmise
