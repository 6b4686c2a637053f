#pragma once
#include <vector>

#include "core/config/scenario.h"

namespace dmise {

/// Noise of a pixel [e-] against the expected electrons of the sky in it, as the sensor's detector
/// makes it (`expected_noise`): tabulated once for a sensor, interpolated in between to 0.1 %.
class NoiseTable {
 public:
  /// `seed`: the scenario's, which fixes hot pixels.
  NoiseTable(const SensorConfig& sensor, std::uint64_t seed);

  /// `sky_e` >= 0; beyond saturation that of saturation.
  double noise_e(double sky_e) const;
  /// Electrons of sky, without dark current, at which a pixel is full.
  double full_sky_e() const { return full_sky_e_; }

 private:
  std::vector<double> sky_e_, variance_e2_;  // ascending in sky
  double full_sky_e_ = 0.0;
};

}  // namespace dmise
