#pragma once
#include "core/config/sensors/sensor_settings.h"

namespace dmise {

class YamlValue;
struct Section;

/// Reads `detector:` of a camera: the fields of `Detector` by name. Throws `ConfigError` for
/// invalid parameters.
Detector read_detector(const YamlValue& value);

/// Throws `ConfigError` for an exposure with more than `max_cosmic_hits` expected cosmic-ray hits.
void check_exposure(const Camera& camera, const YamlValue& exposure_s);

/// The keys of `detector`.
const Section& detector_section();

}  // namespace dmise
