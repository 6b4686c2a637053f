#pragma once
#include "core/config/yaml_reader.h"
#include "core/photometry/band.h"

namespace dmise {

/// `band:` of a camera: the name of a filter (`bessell-V`, `sdss-g`, ...), or a mapping with either
/// `filter` (such a name, or a CSV file of a transmission, see `parse_curve`) or `centre_m` and
/// `width_m` (a top hat); `name` is what products call it.
Band read_band(const YamlValue& value);

/// How a detector answers to photons over wavelength.
struct QuantumEfficiency {
  double peak = 1.0;  // the figure itself where it is one for all wavelengths, (0, 1]
  Curve relative;     // to the peak; empty: flat
};

/// `quantum_efficiency:` a number, or the path of a CSV file.
QuantumEfficiency read_quantum_efficiency(const YamlValue& value);

}  // namespace dmise
