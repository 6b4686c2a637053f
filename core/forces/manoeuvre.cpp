#include "core/forces/manoeuvre.h"

#include <cmath>

namespace dmise {

double mass_left_kg(const Manoeuvre& burn, double time_s) {
  constexpr double standard_gravity_m_per_s2 = 9.80665;
  if (burn.specific_impulse_s == 0.0) return burn.mass_kg;
  return burn.mass_kg - burn.thrust_n / (burn.specific_impulse_s * standard_gravity_m_per_s2) *
                            (time_s - burn.at_s);
}

double burn_m_per_s2(const Manoeuvre& burn, double time_s) {
  return burn.thrust_n / mass_left_kg(burn, time_s);
}

Vec<Gcrs> gcrs_from_rtn(const MotionState<Gcrs>& state, const Vec<Rtn>& v) {
  const Vec<Gcrs> radial = unit(state.position_m);
  Vec<Gcrs> normal = cross(radial, state.velocity_m_per_s);
  if (!(norm(normal) > 1e-12 * norm(state.velocity_m_per_s)))
    normal = cross(radial, std::fabs(radial.z) < 0.9 ? Vec<Gcrs>{0, 0, 1} : Vec<Gcrs>{1, 0, 0});
  normal = unit(normal);
  return radial * v.x + cross(normal, radial) * v.y + normal * v.z;
}

}  // namespace dmise
