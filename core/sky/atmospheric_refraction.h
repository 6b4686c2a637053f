#pragma once
#include "core/effects/plan_facts.h"
#include "core/sky/observer.h"

namespace dmise {

/// The air over a ground observer turns light towards the zenith.
class AtmosphericRefraction {
 public:
  static constexpr EffectFacts facts{"refraction",
                                     "the atmosphere lifts what is seen from the ground",
                                     "58 arcsec at 45 deg elevation, 5.3 arcmin at 10",
                                     "IAU SOFA, eraRefco; Bennett 1982, J. Navigation 35, 255"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }

  /// The sky is looked at where the air shows it: its parts change with direction, most of all near
  /// the Moon and by the twilight.
  static ErrorBound error(int, const PlanFacts& f) {
    constexpr double usual_per_rad = 3.0, steep_per_rad = 10.0;
    return f.shifted_by(f.refraction_rad) + f.without_light([&](const SkySample& s) {
      const double steep_e = s.of(SkyPart::scattered_moonlight) + s.of(SkyPart::twilight);
      return f.refraction_rad * (usual_per_rad * (s.sky_e - steep_e) + steep_per_rad * steep_e);
    });
  }
  static double cost_s(int level, const PlanFacts& f) { return level * 430e-9 * f.stars; }

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
