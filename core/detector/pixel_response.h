#pragma once
#include "core/detector/detector_effect.h"

namespace dmise {

/// Pixel response non-uniformity: light times 1 + rms z with a normal deviate z that a pixel keeps,
/// never below 0.
struct PixelResponse {
  static constexpr EffectFacts facts{"prnu", "every pixel responds to light a little differently",
                                     "a fixed pattern: 0.01 of the light in a usual camera",
                                     "Janesick 2007, Photon Transfer"};
  double prnu_rms = 0.0;  // relative
  bool operator==(const PixelResponse&) const = default;

  static std::span<const DetectorParameter> parameters();
  void switch_off() { prnu_rms = 0.0; }
  bool applies(const Detector&) const { return prnu_rms > 0.0; }
  void apply(const ExposureFacts& exposed, Piece& piece) const;
};

}  // namespace dmise
