#pragma once
#include <numbers>

#include "core/optics/image_effect.h"

namespace dmise {

/// Ghost image from two reflections between glass surfaces: a copy of the image, point-reflected at
/// its centre and out of focus, so that a star becomes a disc. Its light is added: `transmission`
/// is that of the direct path.
struct LensGhost {
  static constexpr EffectFacts facts{
      "lens_ghost", "reflections between lens surfaces add a faint mirrored copy of the image",
      "no ghosts: 1e-5 to 1e-3 of bright sources", "Smith 2008, Modern Optical Engineering"};
  double ghost_fraction = 0.0;    // of the light, 0..0.1
  double ghost_radius_px = 10.0;  // of the disc that a point becomes
  bool operator==(const LensGhost&) const = default;

  static std::span<const ImageParameter> parameters();
  void switch_off() { ghost_fraction = 0.0; }
  bool applies() const { return ghost_fraction > 0.0; }
  void apply(ExpectedElectronImage& image, Threads& threads) const;
  ErrorBound error(int, const PlanFacts& f) const {
    const double disc_px = std::max(1.0, std::numbers::pi * ghost_radius_px * ghost_radius_px);
    ErrorBound error = f.without_light(
        [&](const SkySample& s) { return ghost_fraction * (f.brightest_e() / disc_px + s.sky_e); });
    // A faint source in the ghost of a bright one, which adds at most a tenth of its light: with
    // more it would not count as alone.
    const double capsule_px = 28.0 * std::max(1.0, f.fwhm_px * f.fwhm_px);
    const double share = std::min(0.1, ghost_fraction * std::min(1.0, capsule_px / disc_px) *
                                           f.brightest_e() / f.faintest_source_e());
    error.photometry_mag = 1.086 * (ghost_fraction + share);
    error.position_px = 3.0 * share * std::hypot(1.0, f.fwhm_px);
    return error;
  }
  static double cost_s(int level, const PlanFacts& f) { return level * 10e-9 * f.pixels(); }
};

}  // namespace dmise
