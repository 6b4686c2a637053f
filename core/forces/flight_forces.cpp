#include "core/forces/flight_forces.h"

#include <cmath>

#include "core/forces/acceleration.h"
#include "core/frames/oblate_earth.h"
#include "core/sky/bodies/shadow.h"

namespace dmise {
namespace {

/// Attraction by the tide that a body raises: Love number k2 of an anelastic Earth, without its lag
/// (Montenbruck & Gill 2000, Satellite Orbits, 3.7.2; IERS Conventions 2010, table 6.3).
Vec<Gcrs> tide_m_per_s2(double gm, const Vec<Gcrs>& body_m, const Vec<Gcrs>& r_m) {
  constexpr double love_number = 0.30190;
  const double r = norm(r_m), distance = norm(body_m);
  const double cosine = dot(r_m, body_m) / (r * distance);
  const double ratio = earth_zonal_radius_m / distance, near = earth_zonal_radius_m / r;
  const double factor =
      0.5 * love_number * gm / (distance * distance) * ratio * near * near * near * near;
  return (r_m / r * (3 - 15 * cosine * cosine) + body_m / distance * (6 * cosine)) * factor;
}

/// What general relativity adds to a point mass (Schwarzschild; IERS Conventions 2010, 10.12).
Vec<Gcrs> relativity_m_per_s2(const Vec<Gcrs>& r_m, const Vec<Gcrs>& v_m_per_s) {
  constexpr double c2 = speed_of_light_m_per_s * speed_of_light_m_per_s;
  const double r = norm(r_m);
  const double factor = earth_gm_m3_per_s2 / (c2 * r * r * r);
  return (r_m * (4 * earth_gm_m3_per_s2 / r - dot(v_m_per_s, v_m_per_s)) +
          v_m_per_s * (4 * dot(r_m, v_m_per_s))) *
         factor;
}

double sunlit(const Vec<Gcrs>& sun_m, const OblateEarth& earth, const Vec<Gcrs>& r_m) {
  if (!(norm(earth.stretched(r_m)) > earth.ellipsoid.equatorial_radius_m)) return 0.0;
  return EarthShadow(sun_m, earth).sunlit_fraction(r_m);
}

}  // namespace

FlightForces::FlightForces(std::shared_ptr<const EarthSurroundings> surroundings,
                           const FlightForceSettings& settings)
    : surroundings_(std::move(surroundings)),
      settings_(settings),
      gravity_(settings.gravity_degree) {}

FlightForces::Sunlight FlightForces::sunlight(double time_s, const Vec<Gcrs>& position_m) const {
  if (settings_.radiation_m2_per_kg == 0) return Sunlight::not_felt;
  const EarthSurroundings::At now = surroundings_->at(time_s);
  const double light = sunlit(now.sun_m, {.pole = now.pole}, position_m);
  return light >= 1 ? Sunlight::full : light > 0 ? Sunlight::penumbra : Sunlight::none;
}

Vec<Gcrs> FlightForces::acceleration_m_per_s2(double time_s, const Vec<Gcrs>& position_m,
                                              const Vec<Gcrs>& velocity_m_per_s) const {
  const EarthSurroundings::At now = surroundings_->at(time_s);
  const Vec<Gcrs> g = now.itrs_from_gcrs.inverse() *
                      gravity_.acceleration_m_per_s2(now.itrs_from_gcrs * position_m);
  Triple<double> a{g.x, g.y, g.z};
  const Triple<double> r{position_m.x, position_m.y, position_m.z};
  const double r2 = dot(position_m, position_m);
  if (settings_.sun_moon) {
    add_point(sun_gm_m3_per_s2, now.sun_m, r, r2, a);
    add_point(moon_gm_m3_per_s2, now.moon_m, r, r2, a);
  }
  if (settings_.drag_m2_per_kg != 0) {
    const Triple<double> v{velocity_m_per_s.x, velocity_m_per_s.y, velocity_m_per_s.z};
    add_drag(now.pole, r, v, r2, settings_.drag_m2_per_kg, a);
  }
  Vec<Gcrs> sum{a.x, a.y, a.z};
  if (gravity_.degree() > 0) sum += relativity_m_per_s2(position_m, velocity_m_per_s);
  if (settings_.sun_moon && gravity_.degree() > 0)
    sum += tide_m_per_s2(sun_gm_m3_per_s2, now.sun_m, position_m) +
           tide_m_per_s2(moon_gm_m3_per_s2, now.moon_m, position_m);
  if (settings_.radiation_m2_per_kg != 0) {
    const double light = sunlit(now.sun_m, {.pole = now.pole}, position_m);
    const Vec<Gcrs> from_sun = position_m - now.sun_m;
    const double distance = norm(from_sun);
    if (light > 0)
      sum += from_sun * (light * solar_pressure_n_per_m2 * au_m * au_m *
                         settings_.radiation_m2_per_kg / (distance * distance * distance));
  }
  return sum;
}

}  // namespace dmise
