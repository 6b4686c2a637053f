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
    // Of the background are also pixels that sources light by half of their noise.
    ErrorBound error = f.without_light(
        [&](const SkySample& s) { return 5.5 * prnu_rms * (s.sky_e + 0.5 * s.noise_e); });
    error.photometry_mag = 1.086 * 4.0 * prnu_rms * f.pattern_share();
    // Of a point its own width, of a trail half of its length over the root of three.
    const double along_px = std::max(1.0, f.fwhm_px) + 0.29 * f.longest_trail_px;
    error.position_px = 4.0 * prnu_rms * f.pattern_share(f.longest_trail_px) * along_px;
    return error;
  }
  static double cost_s(int level, const PlanFacts& f) { return level * 6.6e-9 * f.pixels(); }
};

}  // namespace dmise
