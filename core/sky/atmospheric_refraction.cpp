#include "core/sky/atmospheric_refraction.h"

#include <cmath>

namespace dmise {
namespace {

/// Closer to the zenith or nadir there is no azimuth to bend along.
constexpr double least_cosine = 1e-12;

}  // namespace

Vec<Gcrs> AtmosphericRefraction::apply(const Vec<Gcrs>& direction, double distance_m) const {
  const Vec<Gcrs>& up = air_.zenith;
  const double sine = dot(direction, up);
  const Vec<Gcrs> level = direction - up * sine;
  const double cosine = norm(level);
  if (cosine < least_cosine) return direction;
  const auto seen = air_.refraction.apparent_from_true({sine, cosine}, distance_m);
  return level * (seen.cosine / cosine) + up * seen.sine;
}

Vec<Gcrs> AtmosphericRefraction::undo(const Vec<Gcrs>& apparent) const {
  const Vec<Gcrs>& up = air_.zenith;
  const double sine = dot(apparent, up);
  const Vec<Gcrs> level = apparent - up * sine;
  const double cosine = norm(level);
  if (cosine < least_cosine) return apparent;
  const double elevation_rad = air_.refraction.true_from_apparent_rad(std::atan2(sine, cosine));
  return level * (std::cos(elevation_rad) / cosine) + up * std::sin(elevation_rad);
}

}  // namespace dmise
