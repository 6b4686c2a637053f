#pragma once

namespace dmise {

/// A number that a calibration gives a lens.
struct ProjectionCoefficient {
  const char* key;    // in YAML, under `distortion`
  const char* card;   // in FITS headers, of the lens
  int pv = 0;         // m of the FITS card PV2_m, of a projection that FITS has with coefficients
  double most = 0.0;  // its range is -most..most
  const char* comment;
};

}  // namespace dmise
