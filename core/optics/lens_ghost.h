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
  double ghost_fraction = 0.0;    // share of the light, 0..0.1
  double ghost_radius_px = 10.0;  // disc that a point becomes
  bool operator==(const LensGhost&) const = default;

  static std::span<const ImageParameter> parameters();
  void switch_off() { ghost_fraction = 0.0; }
  bool applies() const { return ghost_fraction > 0.0; }
  void apply(ExpectedElectronImage& image, Threads& threads) const;
  ErrorBound error(int, const PlanFacts& f) const;
  static double cost_s(int level, const PlanFacts& f);
};

}  // namespace dmise
