#pragma once
#include "core/effects/effects.h"
#include "core/sky/places/observer.h"

namespace dmise {

/// Bending of starlight by the Sun's gravity.
class LightDeflection {
 public:
  static constexpr EffectFacts facts{"light_deflection", "the Sun's gravity bends starlight",
                                     "4 mas at 90 deg from the Sun", "IAU SOFA, eraLdsun"};

  /// 4.07 mas cot(theta / 2) at 1 au, most at the Sun's limb.
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  explicit LightDeflection(const Observer& observer);
  /// Takes and returns unit vectors.
  Vec<Gcrs> apply(const Vec<Gcrs>& direction) const;

 private:
  Vec<Gcrs> from_sun_;  // unit
  double sun_distance_au_;
};

}  // namespace dmise
