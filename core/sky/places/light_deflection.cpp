#include "core/sky/places/light_deflection.h"

#include <erfa.h>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"

namespace dmise {

ErrorBound LightDeflection::error(int, const PlanFacts& f) {
  const double half_rad = 0.5 * std::max(f.nearest_sun_rad, 4.65e-3);
  return f.shifted_stars(f.stars > 0.0 ? 1.98e-8 / std::tan(half_rad) : 0.0);
}

double LightDeflection::cost_s(int level, const PlanFacts& f) { return level * 116e-9 * f.stars; }

LightDeflection::LightDeflection(const Observer& observer) {
  const Vec<Gcrs> from_sun_m = observer.position_m - observer.solar_system.sun_m;
  sun_distance_au_ = norm(from_sun_m) / au_m;
  from_sun_ = unit(from_sun_m);
}

Vec<Gcrs> LightDeflection::apply(const Vec<Gcrs>& direction) const {
  double from[3] = {direction.x, direction.y, direction.z};
  double sun[3] = {from_sun_.x, from_sun_.y, from_sun_.z};
  double to[3];
  eraLdsun(from, sun, sun_distance_au_, to);
  return {to[0], to[1], to[2]};
}

}  // namespace dmise
