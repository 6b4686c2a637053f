#pragma once
#include "core/detector/detector_effect.h"

namespace dmise {

/// A normal deviate per pixel, new in each frame.
struct ReadNoise {
  static constexpr EffectFacts facts{"read_noise", "noise of the read-out amplifier", "none",
                                     "Janesick 2001, Scientific Charge-Coupled Devices"};
  double read_noise_e = 0.0;  // rms
  bool operator==(const ReadNoise&) const = default;

  static std::span<const DetectorParameter> parameters();
  void switch_off() { read_noise_e = 0.0; }
  bool applies(const Detector&) const { return read_noise_e > 0.0; }
  void apply(const ExposureFacts& exposed, Piece& piece) const;
  /// Its time is in that of the photons' noise.
  static ErrorBound error(int, const PlanFacts& f) {
    return {.noise = f.without_charge(f.read_noise_e * f.read_noise_e).noise};
  }
};

}  // namespace dmise
