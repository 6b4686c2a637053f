#include "core/propagation/run_on.h"

#include "core/base/units.h"
#include "core/sky/places/sun_moon.h"

namespace dmise {

EnvironmentState run_on(EnvironmentState state, SimTime t) {
  const double dt_s = (t - state.time).seconds();
  const SolarSystem later = advance({.sun_m = state.sun_m,
                                     .moon_m = state.moon_m,
                                     .earth_barycentric_m = state.earth_barycentric_m,
                                     .earth_velocity_m_per_s = state.earth_velocity_m_per_s,
                                     .moon_velocity_m_per_s = state.moon_velocity_m_per_s},
                                    dt_s);
  state.sun_m = later.sun_m;
  state.moon_m = later.moon_m;
  state.earth_barycentric_m = later.earth_barycentric_m;
  state.earth_velocity_m_per_s = later.earth_velocity_m_per_s;
  state.moon_velocity_m_per_s = later.moon_velocity_m_per_s;
  state.tt_jd2 += dt_s / day_s;
  state.time = t;
  return state;
}

}  // namespace dmise
