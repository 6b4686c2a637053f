#include "core/sky/light_deflection.h"

#include <erfa.h>

#include "core/base/units.h"

namespace dmise {

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
