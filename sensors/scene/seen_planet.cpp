#include "sensors/scene/seen_planet.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/optics/projection.h"
#include "sensors/scene/bodies_in_field.h"

namespace dmise {
namespace {

/// Sun and Earth at a time of the exposure.
struct BodiesAt {
  Tt tt;
  SolarSystem bodies;
  Vec<Gcrs> observer_m;

  BodiesAt(const View& view, SimTime t) : observer_m(view.observer(t).position_m) {
    const EnvironmentState& e = view.environment();
    const double later_s = (t - e.time).seconds();
    tt = {e.tt_jd1, e.tt_jd2 + later_s / day_s};
    bodies.sun_m = e.sun_m - e.earth_velocity_m_per_s * later_s;
  }
};

bool is_seen(const View& view, Planet planet, SimTime t) {
  const Vec<Gcrs> apparent = seen_planet(view, planet, t).apparent;
  const Optics& optics = view.sensor().camera.optics;
  const auto pixel = project(optics, view.camera_from_gcrs(t) * apparent);
  if (!pixel || !in_frame(optics, *pixel, disc_margin_px)) return false;
  const auto earth = view.earth_occultation(t);
  return !earth || !earth->hides_direction(apparent);
}

}  // namespace

SeenPlanet seen_planet(const View& view, Planet planet, SimTime t) {
  const BodiesAt at(view, t);
  const PlanetPlace place = view.places(t).planet(
      [&](double dt_s) { return planet_line_m(planet, at.tt, at.bodies, at.observer_m, dt_s); });
  const Vec<Gcrs> from_sun_m = place.line_m + at.observer_m - at.bodies.sun_m;
  return {.from_sun_m = from_sun_m,
          .from_observer_m = place.line_m,
          .apparent = place.direction,
          .radius_rad = facts_of(planet).radius_m / norm(place.line_m),
          .v_mag = planet_v_mag(planet, from_sun_m, place.line_m, at.tt)};
}

std::vector<Planet> planets_in_field(const View& view, std::span<const SimTime> times) {
  // A quick bound leaves none of nearly all fields: rough places, aberration, light time and
  // refraction together are within a degree.
  const Optics& optics = view.sensor().camera.optics;
  const double near_rad =
      half_diagonal_rad(optics) + 1.0 * deg + 3.0 * disc_margin_px * optics.pixel_angle_rad();
  std::vector<Vec<Gcrs>> axes;
  for (const SimTime t : times) axes.push_back(view.boresight(t));
  const BodiesAt middle(view, view.times().middle);
  std::vector<Planet> planets;
  for (const Planet planet : all_planets) {
    const Vec<Gcrs> line_m =
        roughly_heliocentric_m(planet, middle.tt) + middle.bodies.sun_m - middle.observer_m;
    const bool is_near = std::ranges::any_of(
        axes, [&](const Vec<Gcrs>& axis) { return angle_rad(axis, line_m) < near_rad; });
    if (is_near && std::ranges::any_of(times, [&](SimTime t) { return is_seen(view, planet, t); }))
      planets.push_back(planet);
  }
  return planets;
}

bool is_drawn_as_disc(const View& view, const SeenPlanet& planet) {
  constexpr double min_radius_px = 0.5;
  return planet.radius_rad >= min_radius_px * view.sensor().camera.optics.pixel_angle_rad();
}

}  // namespace dmise
