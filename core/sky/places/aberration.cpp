#include "core/sky/places/aberration.h"

#include <erfa.h>

#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"

namespace dmise {

ErrorBound AnnualAberration::error(int, const PlanFacts& f) {
  return f.shifted_stars(f.stars > 0.0 ? f.annual_aberration_rad : 0.0);
}

double AnnualAberration::cost_s(int level, const PlanFacts& f) { return level * 6e-9 * f.stars; }

ErrorBound DiurnalAberration::error(int, const PlanFacts& f) {
  return f.shifted_by(f.diurnal_aberration_rad);
}

double DiurnalAberration::cost_s(int level, const PlanFacts& f) { return level * 6e-9 * f.stars; }

Aberration::Aberration(const Vec<Gcrs>& velocity_c, double sun_distance_au)
    : velocity_c_(velocity_c),
      sun_distance_au_(sun_distance_au),
      inverse_gamma_(std::sqrt(1.0 - dot(velocity_c, velocity_c))) {}

Vec<Gcrs> Aberration::apply(const Vec<Gcrs>& direction) const {
  double from[3] = {direction.x, direction.y, direction.z};
  double velocity[3] = {velocity_c_.x, velocity_c_.y, velocity_c_.z};
  double to[3];
  eraAb(from, velocity, sun_distance_au_, inverse_gamma_, to);
  return {to[0], to[1], to[2]};
}

AnnualAberration::AnnualAberration(const Observer& observer)
    : velocity_c(observer.solar_system.earth_velocity_m_per_s / speed_of_light_m_per_s) {}

DiurnalAberration::DiurnalAberration(const Observer& observer)
    : velocity_c(observer.velocity_m_per_s / speed_of_light_m_per_s) {}

}  // namespace dmise
