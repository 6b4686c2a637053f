#pragma once
#include "core/effects/plan_facts.h"
#include "core/sky/observer.h"

namespace dmise {

/// Bending of starlight by the Sun's gravity.
class LightDeflection {
 public:
  static constexpr EffectFacts facts{"light_deflection", "the Sun's gravity bends starlight",
                                     "4 mas at 90 deg from the Sun", "IAU SOFA, eraLdsun"};

  /// 4.07 mas cot(theta / 2) at 1 au, most at the Sun's limb.
  static ErrorBound error(int, const PlanFacts& f) {
    const double half_rad = 0.5 * std::max(f.nearest_sun_rad, 4.65e-3);
    return f.shifted_stars(f.stars > 0.0 ? 1.98e-8 / std::tan(half_rad) : 0.0);
  }
  static double cost_s(int level, const PlanFacts& f) { return level * 116e-9 * f.stars; }

  explicit LightDeflection(const Observer& observer);
  /// Takes and returns unit vectors.
  Vec<Gcrs> apply(const Vec<Gcrs>& direction) const;

 private:
  Vec<Gcrs> from_sun_;  // unit
  double sun_distance_au_;
};

}  // namespace dmise
