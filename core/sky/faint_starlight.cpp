#include "core/sky/faint_starlight.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/sky/stars/star_counts.h"

namespace dmise {

ErrorBound FaintStarlight::error(int, const PlanFacts& f) {
  return f.without_part(SkyPart::faint_starlight);
}

double FaintStarlight::cost_s(int level, const PlanFacts& f) {
  return level * 120e-9 * f.sky_looks();
}

double faint_starlight_s10(const FaintStarlight& starlight, double sin_galactic_latitude) {
  constexpr double plane_s10 = 165.0, optical_depth = 0.13, counted_to_v_mag = 9.0;
  const double s = std::clamp(std::abs(sin_galactic_latitude), 1e-3, 1.0);
  const double fainter = plane_s10 * (1.0 - std::exp(-optical_depth / s));
  const double limit = std::max(starlight.brighter_limit_v_mag, 5.0);
  if (limit >= counted_to_v_mag) return fainter * std::exp2((counted_to_v_mag - limit) / 2.5);
  const double a_magnitude = 4.0 + 7.5 * std::exp(-std::asin(s) / (17.0 * deg));
  return fainter + (counted_to_v_mag - limit) * a_magnitude;
}

double faint_starlight_s10(const FaintStarlight& starlight, const Vec<Galactic>& direction) {
  if (starlight.by_counts)
    return starlight_of_counts_s10(std::max(starlight.brighter_limit_v_mag, 5.0), direction);
  return faint_starlight_s10(starlight, direction.z);
}

}  // namespace dmise
