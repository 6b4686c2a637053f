#pragma once
#include <span>
#include <vector>

#include "core/sky/bodies/planets.h"
#include "sensors/scene/view.h"

namespace dmise {

/// A planet as a camera sees it at one time.
struct SeenPlanet {
  Vec<Gcrs> from_sun_m, from_observer_m;  // where its light left
  Vec<Gcrs> apparent;                     // unit, of its disc's middle
  double radius_rad = 0.0;
  double v_mag = 0.0;  // above the air
};
SeenPlanet seen_planet(const View& view, Planet planet, SimTime t);

/// Planets in the field, or within `disc_margin_px` of it, at one of the times at least, and not
/// behind the Earth.
std::vector<Planet> planets_in_field(const View& view, std::span<const SimTime> times);

/// Whether a planet's disc has a radius from which on it is drawn as one.
bool is_drawn_as_disc(const View& view, const SeenPlanet& planet);

}  // namespace dmise
