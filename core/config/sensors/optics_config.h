#pragma once
#include "core/base/files/json.h"
#include "core/optics/camera.h"
#include "core/optics/waves/seeing.h"

namespace dmise {

class YamlValue;
struct Section;

/// Reads `optics:` of a camera; the keys are those of docs/models/optics.md.
Optics read_optics(const YamlValue& value);

/// Writes the optics that determine a frame, besides the camera's geometry; defaults are omitted.
void write_optics_json(JsonWriter& json, const Optics& optics);
void write_seeing_json(JsonWriter& json, const SensorSeeing& seeing);

/// The keys of `optics`.
const Section& optics_section();

}  // namespace dmise
