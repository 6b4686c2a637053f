#pragma once

namespace dmise {

/// One calibrated coefficient of a lens.
struct ProjectionCoefficient {
  const char* key;    // in YAML, under `distortion`
  const char* card;   // FITS card
  int pv = 0;         // m of PV2_m, if FITS has the projection
  double most = 0.0;  // its range is -most..most
  const char* comment;
};

}  // namespace dmise
