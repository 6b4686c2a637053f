#pragma once
#include "core/detector/detector_effect.h"

namespace dmise {

/// Pixel response non-uniformity: multiplies the light by 1 + rms z, with a fixed normal deviate z
/// per pixel, but not below 0.
struct PixelResponse {
  static constexpr EffectFacts facts{"prnu", "pixel response non-uniformity",
                                     "a fixed pattern: 0.01 of the light in a usual camera",
                                     "Janesick 2007, Photon Transfer"};
  double prnu_rms = 0.0;  // relative
  bool operator==(const PixelResponse&) const = default;

  static std::span<const DetectorParameter> parameters();
  void switch_off() { prnu_rms = 0.0; }
  bool applies(const Detector&) const { return prnu_rms > 0.0; }
  void apply(const ExposureFacts& exposed, Piece& piece) const;
  /// Of a source four deviations of the pattern under it, of the sky five and a half of a pixel:
  /// one source in 16,000 and one pixel in 26 million are beyond.
  ErrorBound error(int, const PlanFacts& f) const {
    ErrorBound error =
        f.without_light([&](const SkySample& s) { return 5.5 * prnu_rms * s.sky_e; });
    const double of_source = 4.0 * prnu_rms * f.pattern_share();
    error.photometry_mag = 1.086 * of_source;
    error.position_px = of_source * std::max(1.0, f.fwhm_px);
    return error;
  }
  static double cost_s(int level, const PlanFacts& f) { return level * 6.6e-9 * f.pixels(); }
};

}  // namespace dmise
