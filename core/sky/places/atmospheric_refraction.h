#pragma once
#include "core/effects/effects.h"
#include "core/sky/places/observer.h"

namespace dmise {

/// The air over a ground observer turns light towards the zenith.
class AtmosphericRefraction {
 public:
  static constexpr EffectFacts facts{"refraction",
                                     "the atmosphere lifts what is seen from the ground",
                                     "58 arcsec at 45 deg elevation, 5.3 arcmin at 10",
                                     "IAU SOFA, eraRefco; Bennett 1982, J. Navigation 35, 255"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }

  /// Without it the sky is evaluated in a direction that is off by the refraction: its parts change
  /// with direction, most near the Moon and in twilight.
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  explicit AtmosphericRefraction(const Observer& observer) : air_(*observer.air) {}
  /// Takes and returns unit vectors; `distance_m` along the straight line, `Refraction::star` of
  /// stars.
  Vec<Gcrs> apply(const Vec<Gcrs>& direction, double distance_m) const;
  /// The direction without air of a star that is seen at an apparent one.
  Vec<Gcrs> undo(const Vec<Gcrs>& apparent) const;

 private:
  Air air_;
};

}  // namespace dmise
