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

  /// Without it the sky is evaluated in a direction that is off by the refraction: its parts change
  /// with direction, most near the Moon and in twilight.
  static ErrorBound error(int, const PlanFacts& f) {
    constexpr double usual_per_rad = 3.0, steep_per_rad = 10.0;
    // Moonlight by the Moon's elevation: 0.9 mag a degree below the horizon, above it by
    // extinction.
    constexpr double moon_down_per_rad = 48.0, moon_up_per_rad = 4.0;
    const double moonlight_per_rad = std::max(steep_per_rad, 2.0 / f.nearest_moon_rad);
    const double moon =
        f.moon_refraction_rad * (f.moon_is_down ? moon_down_per_rad : moon_up_per_rad);
    return f.shifted_by(f.refraction_rad) + f.without_light([&](const SkySample& s) {
      const double moonlight_e = f.moonlight_e(s), twilight_e = s.of(SkyPart::twilight);
      const double rest_e = s.sky_e - twilight_e - s.of(SkyPart::scattered_moonlight);
      return f.refraction_rad * (usual_per_rad * rest_e + steep_per_rad * twilight_e) +
             std::min(1.0, moon + f.refraction_rad * moonlight_per_rad) * moonlight_e;
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
