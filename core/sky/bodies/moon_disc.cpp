#include "core/sky/bodies/moon_disc.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/photometry/magnitude.h"
#include "core/sky/scattered_moonlight.h"
#include "core/sky/sky_model.h"

namespace dmise {

ErrorBound MoonDisc::error(int, const PlanFacts& f) {
  return f.scene.moon_in_field ? not_bounded : ErrorBound{};
}

double MoonDisc::cost_s(int level, const PlanFacts& f) { return level * 400e-9 * f.pixels(); }

double lommel_seeliger_phase(double phase_rad) {
  const double a = std::clamp(std::abs(phase_rad), 0.0, pi);
  const double from_dark = pi - a;
  if (a < 1e-6) return 1.0;
  // Near new Moon the terms cancel: the series is exact to 1e-6 of itself there.
  if (from_dark < 2e-3) return from_dark * from_dark / 6.0;
  return 1.0 - std::sin(0.5 * a) * std::tan(0.5 * a) * -std::log(std::tan(0.25 * a));
}

double moon_disc_v_mag(double phase_rad) {
  const double a = std::abs(phase_rad);
  if (a <= moon_crescent_from_rad) return moon_v_mag(a) + opposition_surge_mag(a);
  return moon_v_mag(moon_crescent_from_rad) +
         magnitude_of_light(lommel_seeliger_phase(a) /
                            lommel_seeliger_phase(moon_crescent_from_rad));
}

double moonlight_photons_per_s_m2(double v_mag, const Band& band) {
  return light_of_magnitude(v_mag) * zero_point_photons_per_s_m2(johnson_v()) *
         photon_rate_per_m2(moonlight_spectrum(), band) /
         photon_rate_per_m2(moonlight_spectrum(), johnson_v());
}

double moonlight_over_sunlight(const Vec<Gcrs>& moon_m, const Vec<Gcrs>& sun_m) {
  const double phase_rad = angle_rad(sun_m - moon_m, -moon_m);
  if (!(lommel_seeliger_phase(phase_rad) > 0.0)) return 0.0;
  const double distance = norm(moon_m) / mean_moon_distance_m, au = norm(sun_m) / au_m;
  return light_of_magnitude(moon_disc_v_mag(phase_rad) - sun_v_mag) * au * au /
         (distance * distance);
}

double moonlight_colour(const Band& band) {
  return moonlight_photons_per_s_m2(0.0, band) / sunlight_photons_per_s_m2(0.0, band);
}

double lommel_seeliger_photocentre(double phase_rad) {
  const double a = std::clamp(std::abs(phase_rad), 0.0, pi), width = pi - a;
  if (width < 1e-3) return 1.0;
  // Along latitudes over the plane of Sun and observer the integrals are 4/3 and pi/2.
  constexpr int steps = 64;
  double light = 0.0, aside = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double longitude = a - pi / 2 + width * (i + 0.5) / steps;
    const double mu = std::cos(longitude), mu0 = std::cos(longitude - a);
    const double part = mu * mu0 / (mu + mu0);
    light += part;
    aside += part * std::sin(longitude);
  }
  return aside / light * (4.0 / 3.0) / (pi / 2);
}

LitSphere::LitSphere(const Vec<Gcrs>& centre_m, const Vec<Gcrs>& sun_m, double radius_m,
                     double whole)
    : centre_(unit(centre_m)),
      to_sun_(unit(sun_m - centre_m)),
      phase_rad_(angle_rad(sun_m - centre_m, -centre_m)),
      radius_rad_(std::asin(std::min(1.0, radius_m / norm(centre_m)))) {
  const double lit = lommel_seeliger_phase(phase_rad_);
  whole_ = lit > 0.0 ? whole : 0.0;
  // mu mu0 / (mu0 + mu) over the sphere is pi / 2 times the phase function.
  const double size = radius_m / norm(centre_m);
  scale_ = lit > 0.0 ? whole_ / (0.5 * pi * lit * size * size) : 0.0;
}

namespace {

double moonlight_at(const Band& band, const Vec<Gcrs>& moon_m, const Vec<Gcrs>& sun_m) {
  const double distance = norm(moon_m) / mean_moon_distance_m;
  return moonlight_photons_per_s_m2(moon_disc_v_mag(angle_rad(sun_m - moon_m, -moon_m)), band) /
         distance / distance;
}

}  // namespace

MoonRadiance::MoonRadiance(const Band& band, const Vec<Gcrs>& moon_m, const Vec<Gcrs>& sun_m)
    : LitSphere(moon_m, sun_m, moon_radius_m, moonlight_at(band, moon_m, sun_m)) {}

double LitSphere::photons_per_s_m2_sr(const Vec<Gcrs>& direction) const {
  const double along = dot(direction, centre_), sine = std::sin(radius_rad_);
  const Vec<Gcrs> aside = (direction - centre_ * along) / sine;
  const double r2 = dot(aside, aside);
  if (along <= 0.0 || r2 > 1.0) return -1.0;
  const double seen = std::sqrt(1.0 - r2);
  const double lit = dot(aside - centre_ * seen, to_sun_);
  return lit > 0.0 ? scale_ * lit / (lit + seen) : 0.0;
}

}  // namespace dmise
