#pragma once
#include "core/optics/image_effect.h"

namespace dmise {

/// A ghost of the light in the frame, reflected twice between glass surfaces: its copy by point
/// reflection at the centre of the image, out of focus, so that a star's is a disc. What it has is
/// not taken from the direct light: `transmission` is that of the direct way.
struct LensGhost {
  static constexpr EffectFacts facts{
      "lens_ghost", "glass surfaces throw a faint mirrored copy of bright light",
      "no ghosts: 1e-5 to 1e-3 of what is bright", "Smith 2008, Modern Optical Engineering"};
  double ghost_fraction = 0.0;    // of the light, 0..0.1
  double ghost_radius_px = 10.0;  // of the disc that a point becomes
  bool operator==(const LensGhost&) const = default;

  static std::span<const ImageParameter> parameters();
  void switch_off() { ghost_fraction = 0.0; }
  bool applies() const { return ghost_fraction > 0.0; }
  void apply(ExpectedElectronImage& image, Threads& threads) const;
};

}  // namespace dmise
