#include "core/sky/places/atmospheric_refraction.h"

#include <cmath>

#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

/// Closer to the zenith or nadir there is no azimuth to bend along.
constexpr double min_cosine = 1e-12;

}  // namespace

ErrorBound AtmosphericRefraction::error(int, const PlanFacts& f) {
  constexpr double usual_per_rad = 3.0, steep_per_rad = 10.0;
  // Moonlight by the Moon's elevation: 0.9 mag a degree below the horizon, above it by
  // extinction.
  constexpr double moon_down_per_rad = 48.0, moon_up_per_rad = 4.0;
  const double moonlight_per_rad = std::max(steep_per_rad, 2.0 / f.nearest_moon_rad);
  const double moon =
      f.moon_refraction_rad * (f.moon_is_down ? moon_down_per_rad : moon_up_per_rad);
  return f.shifted_by(f.refraction_rad) + f.without_light([&](const SkySample& s) {
    const double moonlight_e = f.moonlight_e(s), twilight_e = s.of(SkyPart::twilight);
    const double rest_e = s.sky_e - twilight_e - s.of(SkyPart::scattered_moonlight);
    return f.refraction_rad * (usual_per_rad * rest_e + steep_per_rad * twilight_e) +
           std::min(1.0, moon + f.refraction_rad * moonlight_per_rad) * moonlight_e;
  });
}

double AtmosphericRefraction::cost_s(int level, const PlanFacts& f) {
  return level * 430e-9 * f.stars;
}

Vec<Gcrs> AtmosphericRefraction::apply(const Vec<Gcrs>& direction, double distance_m) const {
  const Vec<Gcrs>& up = air_.zenith;
  const double sine = dot(direction, up);
  const Vec<Gcrs> level = direction - up * sine;
  const double cosine = norm(level);
  if (cosine < min_cosine) return direction;
  const auto seen = air_.refraction.apparent_from_true({sine, cosine}, distance_m);
  return level * (seen.cosine / cosine) + up * seen.sine;
}

Vec<Gcrs> AtmosphericRefraction::undo(const Vec<Gcrs>& apparent) const {
  const Vec<Gcrs>& up = air_.zenith;
  const double sine = dot(apparent, up);
  const Vec<Gcrs> level = apparent - up * sine;
  const double cosine = norm(level);
  if (cosine < min_cosine) return apparent;
  const double elevation_rad = air_.refraction.true_from_apparent_rad(std::atan2(sine, cosine));
  return level * (std::cos(elevation_rad) / cosine) + up * std::sin(elevation_rad);
}

}  // namespace dmise
