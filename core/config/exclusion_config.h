#pragma once
#include "core/base/json.h"
#include "core/config/yaml_reader.h"
#include "core/optics/exclusion.h"

namespace dmise {

/// The keys of `exclusion` of a camera.
const Section& exclusion_section();
Exclusion read_exclusion(const YamlValue& value);
/// Refuses `earth_limb_deg` of the camera `value` of a sensor on the ground.
void check_exclusion_on_ground(const YamlValue& value, const Exclusion& exclusion);
/// What stands in digests; nothing for a camera without it.
void write_exclusion_json(JsonWriter& json, const Exclusion& exclusion);

}  // namespace dmise
