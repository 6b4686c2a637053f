#pragma once
#include "core/config/yaml/section.h"
#include "core/photometry/band.h"

namespace dmise {

class YamlValue;

/// Reads `band:` of a camera: the name of a filter (`bessell-V`, `sdss-g`, ...), or a mapping with
/// either `filter` (such a name, or a CSV file of a transmission, see `parse_curve`) or `centre_m`
/// and `width_m` (a top hat); `name` is used in products.
Band read_band(const YamlValue& value);

/// Photon response of a detector over wavelength.
struct QuantumEfficiency {
  double peak = 1.0;  // (0, 1]; the value itself if it is constant
  Curve relative;     // relative to the peak; empty: flat
};

/// Reads `quantum_efficiency:`, a number or the path of a CSV file.
QuantumEfficiency read_quantum_efficiency(const YamlValue& value);

/// The forms of `band`.
Forms band_forms();

}  // namespace dmise
