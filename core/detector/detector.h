#pragma once

namespace dmise {

/// A detector's figures; every one has its place in the chain of docs/models.
struct Detector {
  double quantum_efficiency = 1.0;  // mean over the band, (0, 1]
  double dark_e_per_s = 0.0;
  double read_noise_e = 0.0;  // rms
  double full_well_e = 1e5;
  double gain_e_per_dn = 1.0;
  double bias_dn = 0.0;
  int adc_bits = 16;  // 1..16

  bool operator==(const Detector&) const = default;
};

/// Throws `ConfigError` "detector.KEY: reason, got value" for figures that no detector can have.
void check(const Detector& detector);

}  // namespace dmise
