#pragma once
#include <limits>
#include <memory>

#include "core/effects/effects.h"
#include "core/photometry/band.h"
#include "core/sky/limb_line.h"

namespace dmise {

/// Loss of one band in the air over the limb, by the lowest height of rays.
struct LimbRays;

/// From space: air over the Earth's limb dims what is behind it. Molecules and ozone, for sunlight
/// (`GrazingAir`), without haze and clouds; and points by the spreading of their rays, which are
/// bent the more the lower they pass. Directions stay as they are without air: it lifts a star by
/// 0.07 deg where its ray passes at 20 km, by up to 1.2 deg at the ground.
class LimbExtinction {
 public:
  static constexpr EffectFacts facts{
      "limb_extinction", "air over the Earth's limb dims what is behind it, seen from space",
      "1.8 mag at a tangent height of 20 km, 3 mag at 10 km in V",
      "International Standard Atmosphere; Hansen & Travis 1974; Bird & Riordan 1986"};
  static bool applies(const SceneFacts& scene) { return scene.limb_in_field; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
  /// From this tangent height on nothing is lost.
  static constexpr double top_m = 100e3;

  LimbExtinction(const Band& band, const LimbSight& sight);

  /// Share of a point's light that is left, [0, 1]; 1 for a point before the air. `distance_m`:
  /// from the observer.
  double of_point(const Vec<Gcrs>& direction,
                  double distance_m = std::numeric_limits<double>::infinity()) const;
  /// Factor of the surface brightness of what is behind.
  double of_surface(const Vec<Gcrs>& direction) const { return of_surface(sight_.line(direction)); }
  double of_surface(const LimbLine& line) const;

 private:
  LimbSight sight_;
  std::shared_ptr<const LimbRays> rays_;
};

}  // namespace dmise
