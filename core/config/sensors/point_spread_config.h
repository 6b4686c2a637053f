#pragma once
#include <vector>

#include "core/base/files/json.h"
#include "core/config/yaml/section.h"
#include "core/optics/camera.h"

namespace dmise {

class YamlMap;

/// The keys of `optics` that say how points are blurred.
std::vector<Key> point_spread_keys();

/// Reads them. `psf: gaussian` has its width, `psf: diffraction` the parameters of a pupil, `psf:
/// file` images; keys of the others are refused. Sets the width of `optics`, whose pixels, lens and
/// aperture are known.
PointSpread read_point_spread(YamlMap& map, Optics& optics);

/// Writes what is not at its default, for digests.
void write_point_spread_json(JsonWriter& json, const PointSpread& spread);

}  // namespace dmise
