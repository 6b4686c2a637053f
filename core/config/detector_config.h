#pragma once
#include "core/config/scenario.h"
#include "core/config/yaml_reader.h"

namespace dmise {

/// Reads `detector:` of a camera: the fields of `Detector` by their names. Throws `ConfigError` for
/// figures that no detector can have.
Detector read_detector(const YamlValue& value);

/// Refuses an exposure that the detector can't be simulated in: one of more than
/// `most_cosmic_hits`.
void check_exposure(const Camera& camera, const YamlValue& exposure_s);

}  // namespace dmise
