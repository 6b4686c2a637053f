#include "core/forces/earth_surroundings.h"

#include <cmath>

#include "core/base/numeric/table_place.h"
#include "core/base/units.h"
#include "core/forces/cubic.h"
#include "core/sky/places/sun_moon.h"

namespace dmise {
namespace {

template <class To, class From>
Rotation<To, From> between(const Rotation<To, From>& a, const Rotation<To, From>& b, double u) {
  Rotation<To, From> out;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out.m[i][j] = a.m[i][j] * (1 - u) + b.m[i][j] * u;
  return out;
}

}  // namespace

EarthSurroundings::EarthSurroundings(const Clock& clock, double first_s, double last_s)
    : first_s_(first_s) {
  const int count = 2 + int((last_s - first_s) / node_s);
  nodes_.reserve(std::size_t(count));
  for (int i = 0; i < count; ++i) {
    const SimTime time = sim_seconds(first_s + i * node_s);
    const EarthOrientation earth = earth_orientation(clock, time);
    const SolarSystem bodies = solar_system(clock.tt(time));
    double turn_rad = earth.era_rad - earth_turn_rad_per_s * time.seconds();
    if (i > 0)
      turn_rad = nodes_.back().turn_rad + std::remainder(turn_rad - nodes_.back().turn_rad, 2 * pi);
    nodes_.push_back({earth.cirs_from_gcrs, earth.itrs_from_tirs, turn_rad, bodies.sun_m,
                      -bodies.earth_velocity_m_per_s, bodies.moon_m, bodies.moon_velocity_m_per_s});
  }
}

EarthSurroundings::At EarthSurroundings::at(double time_s) const {
  const auto [i, u] = table_place((time_s - first_s_) / node_s, nodes_.size());
  const Node &a = nodes_[i], &b = nodes_[i + 1];
  const double angle_rad = a.turn_rad * (1 - u) + b.turn_rad * u + earth_turn_rad_per_s * time_s;
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  Rotation<Tirs, Cirs> turned;
  turned.m = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
  const auto cirs_from_gcrs = between(a.cirs_from_gcrs, b.cirs_from_gcrs, u);
  const auto& pole = cirs_from_gcrs.m[2];
  return {between(a.itrs_from_tirs, b.itrs_from_tirs, u) * turned * cirs_from_gcrs,
          {pole[0], pole[1], pole[2]},
          cubic_between(a.sun_m, a.sun_m_per_s, b.sun_m, b.sun_m_per_s, node_s, u),
          cubic_between(a.moon_m, a.moon_m_per_s, b.moon_m, b.moon_m_per_s, node_s, u)};
}

}  // namespace dmise
