#pragma once
#include "core/base/files/json.h"
#include "core/optics/camera.h"

// The optics of a camera that depend on the distance from the axis or on time: vignetting, the
// point spread over the field, stray light, the drift of the focus.
namespace dmise {

class YamlValue;
struct Section;

const Section& vignetting_section();
const Section& psf_field_section();
const Section& focus_drift_section();
const Section& stray_light_section();

Vignetting read_vignetting(const YamlValue& value);
/// Has widths with `psf: gaussian`, a wavefront with `psf: diffraction`.
FieldBlur read_psf_field(const YamlValue& value, bool diffraction);
FocusDrift read_focus_drift(const YamlValue& value);
StrayLight read_stray_light(const YamlValue& value);

/// Noll's index of a Zernike term, `least` to 66, that is the key of `value`.
int noll_index(const std::string& key, int least, const YamlValue& value);

/// Writes what is not at its default, for digests.
void write_field_tables_json(JsonWriter& json, const Optics& optics);

}  // namespace dmise
