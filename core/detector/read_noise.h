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
};

}  // namespace dmise
