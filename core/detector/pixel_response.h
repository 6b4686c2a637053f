#pragma once
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// Pixel response non-uniformity: multiplies the light by 1 + rms z, with a fixed normal deviate z
/// per pixel, but not below 0.
struct PixelResponse {
  static constexpr EffectFacts facts{"prnu", "pixel response non-uniformity",
                                     "a fixed pattern: 0.01 of the light in a usual camera",
                                     "Janesick 2007, Photon Transfer"};
  double prnu_rms = 0.0;  // relative
  bool operator==(const PixelResponse&) const = default;

  static std::span<const ParameterOf<PixelResponse>> parameters();
  void switch_off() { prnu_rms = 0.0; }
  bool applies(const Detector&) const { return prnu_rms > 0.0; }
  void apply(const ExposureFacts& exposed, Piece& piece) const;
  /// A source errs by four deviations of the pattern under it, a pixel of sky by five and a half:
  /// one source in 16,000 and one pixel in 26 million are beyond.
  ErrorBound error(int, const PlanFacts& f) const;
  static double cost_s(int level, const PlanFacts& f);
};

}  // namespace dmise
