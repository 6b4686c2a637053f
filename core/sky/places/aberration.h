#pragma once
#include "core/effects/effects.h"
#include "core/sky/places/observer.h"

namespace dmise {

/// Aberration of light by a velocity of the observer. Velocities add before light is turned once:
/// the effects below give one each.
class Aberration {
 public:
  /// `velocity_c`: in units of the speed of light. `sun_distance_au` is for the Sun's potential.
  Aberration(const Vec<Gcrs>& velocity_c, double sun_distance_au);
  /// Takes and returns unit vectors. Source: IAU SOFA, eraAb.
  Vec<Gcrs> apply(const Vec<Gcrs>& direction) const;

 private:
  Vec<Gcrs> velocity_c_;
  double sun_distance_au_, inverse_gamma_;
};

/// The Earth's motion about the barycentre of the solar system, which Earth satellites share.
struct AnnualAberration {
  static constexpr EffectFacts facts{"annual_aberration", "the Earth's motion displaces stars",
                                     "up to 20.5 arcsec", "IAU SOFA, eraAb"};
  static constexpr bool displaces_satellites = false;
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  explicit AnnualAberration(const Observer& observer);
  Vec<Gcrs> velocity_c;
};

/// The observer's motion about the Earth's centre.
struct DiurnalAberration {
  static constexpr EffectFacts facts{
      "diurnal_aberration", "the observer's geocentric motion displaces everything",
      "0.32 arcsec on the ground, 5.2 in a low orbit", "IAU SOFA, eraAb"};
  static constexpr bool displaces_satellites = true;
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  explicit DiurnalAberration(const Observer& observer);
  Vec<Gcrs> velocity_c;
};

}  // namespace dmise
