#pragma once
#include "core/base/files/json.h"
#include "core/optics/exclusion.h"

namespace dmise {

class YamlValue;
struct Section;

/// The keys of `exclusion` of a camera.
const Section& exclusion_section();
/// Reads `exclusion` of a camera. Throws `ConfigError` if it names no body.
Exclusion read_exclusion(const YamlValue& value);
/// Throws `ConfigError` if the camera of a sensor on the ground, `value`, has `earth_limb_deg`.
void check_exclusion_on_ground(const YamlValue& value, const Exclusion& exclusion);
/// Writes it for digests; nothing for a camera without exclusion.
void write_exclusion_json(JsonWriter& json, const Exclusion& exclusion);

}  // namespace dmise
