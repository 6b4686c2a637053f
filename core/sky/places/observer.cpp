#include "core/sky/places/observer.h"

#include "core/base/units.h"

namespace dmise {

Observer ground_observer(const Site& site, const EarthOrientation& earth, SimTime t, const Tt& tt,
                         const SolarSystem& solar_system, const Refraction& refraction) {
  const Rotation<Gcrs, Itrs> gcrs_from_itrs = earth.itrs_from_gcrs(t).inverse();
  const Vec<Itrs> site_m = itrs_from_geodetic(site);
  const Vec<Gcrs> zenith = gcrs_from_itrs * (enu_from_itrs(site).inverse() * Vec<Enu>{0, 0, 1});
  return {.time = tt,
          .solar_system = solar_system,
          .position_m = gcrs_from_itrs * site_m,
          .velocity_m_per_s = earth.velocity_of_fixed_point(site_m, t),
          .air = Air{zenith, refraction}};
}

Observer space_observer(const Vec<Gcrs>& position_m, const Vec<Gcrs>& velocity_m_per_s,
                        const Tt& tt, const SolarSystem& solar_system) {
  return {.time = tt,
          .solar_system = solar_system,
          .position_m = position_m,
          .velocity_m_per_s = velocity_m_per_s};
}

Vec<Gcrs> barycentric_au(const Observer& observer) {
  return (observer.solar_system.earth_barycentric_m + observer.position_m) / au_m;
}

}  // namespace dmise
