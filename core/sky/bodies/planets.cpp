#include "core/sky/bodies/planets.h"

#include <erfa.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/sky/bodies/moon_disc.h"

namespace dmise {
namespace {

/// Vectors [1e-9 au] of a sinusoid whose frequency is a multiple of one in `period_days`.
struct Term {
  int frequency;
  std::array<int, 3> cosine, sine;
};
#include "core/sky/bodies/planet_terms.inc"

constexpr double term_unit_au = 1e-9;
constexpr double first_jd = 2415020.5, period_days = 16 * 73049.0;

struct Row {
  PlanetFacts facts;
  int erfa_number;
  std::span<const Term> terms;
};
constexpr Row rows[] = {{{"Mercury", 2440.53e3, 0.97}, 1, mercury_terms},
                        {{"Venus", 6051.8e3, 0.81}, 2, venus_terms},
                        {{"Mars", 3396.19e3, 1.43}, 4, mars_terms},
                        {{"Jupiter", 71492e3, 0.87}, 5, jupiter_terms},
                        {{"Saturn", 60268e3, 1.09}, 6, saturn_terms},
                        {{"Uranus", 25559e3, 0.50}, 7, uranus_terms},
                        {{"Neptune", 24764e3, 0.39}, 8, neptune_terms}};

const Row& row_of(Planet planet) { return rows[std::size_t(planet)]; }

/// Poles of rotation: Saturn's and its rings', right ascension 40.589, declination 83.537 deg;
/// Uranus', 257.311 and -15.175. Source: Archinal et al. 2018.
Vec<Gcrs> pole(double ra_deg, double dec_deg) {
  return from_spherical<Gcrs>(ra_deg * deg, dec_deg * deg);
}
const Vec<Gcrs> saturn_pole = pole(40.589, 83.537), uranus_pole = pole(257.311, -15.175);

/// c0 + c1 x + c2 x^2 ..
double polynomial(std::initializer_list<double> coefficients, double x) {
  double sum = 0.0;
  for (auto c = std::rbegin(coefficients); c != std::rend(coefficients); ++c) sum = sum * x + *c;
  return sum;
}

/// Latitude of an observer over a planet's equator; `line`: from the observer to the planet.
double latitude_rad(const Vec<Gcrs>& pole, const Vec<Gcrs>& line) {
  return angle_rad(pole, line) - pi / 2;
}

double saturn_v_mag(double phase_deg, const Vec<Gcrs>& from_sun, const Vec<Gcrs>& from_observer) {
  constexpr double max_tilt_deg = 27.0;
  const double sun_rad = latitude_rad(saturn_pole, from_sun),
               observer_rad = latitude_rad(saturn_pole, from_observer);
  // The rings' dark side adds nothing.
  const double tilt_rad =
      std::min(std::sqrt(std::max(0.0, sun_rad * observer_rad)), max_tilt_deg * deg);
  return -8.914 - 1.825 * std::sin(tilt_rad) + 0.026 * phase_deg -
         0.378 * std::sin(tilt_rad) * std::exp(-2.25 * phase_deg);
}

double uranus_v_mag(const Vec<Gcrs>& from_sun, const Vec<Gcrs>& from_observer) {
  const double sum_rad = std::abs(latitude_rad(uranus_pole, from_sun)) +
                         std::abs(latitude_rad(uranus_pole, from_observer));
  return -7.110 - 0.00084 * 0.5 * sum_rad / deg;
}

/// V at 1 au from Sun and observer.
double v_mag_at_1_au(Planet planet, double phase_deg, const Vec<Gcrs>& from_sun,
                     const Vec<Gcrs>& from_observer, const Tt& tt) {
  switch (planet) {
    case Planet::mercury:
      return polynomial(
          {-0.613, 6.3280e-2, -1.6336e-3, 3.3644e-5, -3.4265e-7, 1.6893e-9, -3.0334e-12},
          phase_deg);
    case Planet::venus:
      return phase_deg < 163.7
                 ? polynomial({-4.384, -1.044e-3, 3.687e-4, -2.814e-6, 8.938e-9}, phase_deg)
                 : polynomial({236.05828, -2.81914, 8.39034e-3}, phase_deg);
    case Planet::mars:
      return phase_deg <= 50.0 ? polynomial({-1.601, 2.267e-2, -1.302e-4}, phase_deg)
                               : polynomial({-0.367, -0.02573, 3.445e-4}, phase_deg);
    case Planet::jupiter:
      return polynomial({-9.395, -3.7e-4, 6.16e-4}, std::min(phase_deg, 12.0));
    case Planet::saturn:
      return saturn_v_mag(std::min(phase_deg, 6.5), from_sun, from_observer);
    case Planet::uranus:
      return uranus_v_mag(from_sun, from_observer);
    case Planet::neptune:
      return std::clamp(-6.89 - 0.0054 * (20.0 + julian_years_since_j2000(tt)), -7.00, -6.89);
  }
  return 0.0;
}

}  // namespace

ErrorBound Planets::error(int, const PlanFacts& f) {
  return f.scene.planets_in_field ? not_bounded : ErrorBound{};
}

double Planets::cost_s(int level, const PlanFacts&) { return level * 100e-6; }

const PlanetFacts& facts_of(Planet planet) { return row_of(planet).facts; }

Vec<Gcrs> roughly_heliocentric_m(Planet planet, const Tt& tt) {
  double pv[2][3];
  eraPlan94(tt.jd1, tt.jd2, row_of(planet).erfa_number, pv);
  return Vec<Gcrs>{pv[0][0], pv[0][1], pv[0][2]} * au_m;
}

Vec<Gcrs> heliocentric_m(Planet planet, const Tt& tt) {
  const double turns = ((tt.jd1 - first_jd) + tt.jd2) / period_days;
  Vec<Gcrs> sum;
  for (const Term& term : row_of(planet).terms) {
    const double phase_rad = 2.0 * pi * term.frequency * turns;
    const double cosine = std::cos(phase_rad), sine = std::sin(phase_rad);
    sum += Vec<Gcrs>{term.cosine[0] * cosine + term.sine[0] * sine,
                     term.cosine[1] * cosine + term.sine[1] * sine,
                     term.cosine[2] * cosine + term.sine[2] * sine};
  }
  return roughly_heliocentric_m(planet, tt) + sum * (term_unit_au * au_m);
}

Vec<Gcrs> planet_line_m(Planet planet, const Tt& tt, const SolarSystem& bodies,
                        const Vec<Gcrs>& observer_m, double dt_s) {
  return heliocentric_m(planet, {tt.jd1, tt.jd2 + dt_s / day_s}) + bodies.sun_m - observer_m;
}

Vec<Gcrs> photocentre(Planet planet, const Vec<Gcrs>& direction, const Vec<Gcrs>& from_sun_m,
                      const Vec<Gcrs>& from_observer_m) {
  const Vec<Gcrs> to_sun = -unit(from_sun_m);
  const Vec<Gcrs> aside = to_sun - direction * dot(direction, to_sun);
  const double length = norm(aside);
  if (!(length > 1e-9)) return direction;
  const double shift_rad = facts_of(planet).radius_m / norm(from_observer_m) *
                           lommel_seeliger_photocentre(angle_rad(from_sun_m, from_observer_m));
  return unit(direction + aside * (shift_rad / length));
}

double planet_v_mag(Planet planet, const Vec<Gcrs>& from_sun_m, const Vec<Gcrs>& from_observer_m,
                    const Tt& tt) {
  const double phase_deg = angle_rad(from_sun_m, from_observer_m) / deg;
  return v_mag_at_1_au(planet, phase_deg, from_sun_m, from_observer_m, tt) +
         5.0 * std::log10(norm(from_sun_m) / au_m * (norm(from_observer_m) / au_m));
}

}  // namespace dmise
