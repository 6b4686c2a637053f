#include "core/astrometry/plate_sky.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

/// Displacement of a star by aberration, refraction at the horizon, and motions since the epoch.
constexpr double max_displaced_rad = 0.7 * deg;

}  // namespace

PlateSky::PlateSky(const StarMap& map, const Observer& observer)
    : map_(map), air_(observer.air), places_(observer, {}) {
  if (!map.is_small()) return;
  sorted_v_mag_.assign(map.stars.v_mag.begin(), map.stars.v_mag.end());
  std::sort(sorted_v_mag_.begin(), sorted_v_mag_.end());
}

Vec<Gcrs> PlateSky::direction(std::uint32_t star) const {
  const StarTable& s = map_.stars;
  return places_.star({.ra_rad = s.ra_rad[star],
                       .dec_rad = s.dec_rad[star],
                       .pm_ra_cosdec_rad_per_yr = s.pm_ra_cosdec_rad_per_yr[star],
                       .pm_dec_rad_per_yr = s.pm_dec_rad_per_yr[star],
                       .parallax_rad = s.parallax_rad[star],
                       .epoch_jyear = s.epoch_jyear});
}

std::size_t PlateSky::brighter_than(float v_mag) const {
  if (!map_.is_small()) return map_.summary.brighter_than(v_mag);
  return std::size_t(std::upper_bound(sorted_v_mag_.begin(), sorted_v_mag_.end(), v_mag) -
                     sorted_v_mag_.begin());
}

float PlateSky::magnitude_of_rank(double rank) const {
  if (!map_.is_small()) return float(map_.summary.magnitude_of_rank(rank));
  if (sorted_v_mag_.empty()) return 0.0F;
  const double last = double(sorted_v_mag_.size() - 1);
  return sorted_v_mag_[std::size_t(std::clamp(rank, 0.0, last))];
}

std::vector<std::uint32_t> PlateSky::catalogued(const Vec<Gcrs>& axis, double radius_rad,
                                                double rank) const {
  std::vector<std::uint32_t> found;
  query_cone(map_, axis, radius_rad, magnitude_of_rank(rank), found);
  return found;
}

std::vector<SeenStar> PlateSky::brightest(const Vec<Gcrs>& axis, double radius_rad,
                                          std::size_t most) const {
  const double share = 0.5 * (1 - std::cos(std::min(radius_rad, pi)));
  std::vector<std::uint32_t> found;
  // Twice as many as on average, because stars crowd in the Milky Way; all of them if too few.
  for (double rank = 2.0 * double(most) / share;; rank *= 4) {
    found = catalogued(axis, radius_rad + max_displaced_rad, rank);
    if (found.size() >= most || rank >= double(map_.stars.size())) break;
  }
  const auto brighter = [&](std::uint32_t a, std::uint32_t b) {
    const float va = map_.stars.v_mag[a], vb = map_.stars.v_mag[b];
    return va != vb ? va < vb : a < b;
  };
  std::sort(found.begin(), found.end(), brighter);
  std::vector<SeenStar> out;
  for (const std::uint32_t i : found) {
    if (out.size() >= most) break;
    const Vec<Gcrs> seen = direction(i);
    if (angle_rad(seen, axis) > radius_rad || (air_ && dot(seen, air_->zenith) < 0)) continue;
    out.push_back({i, seen, map_.stars.v_mag[i], map_.stars.bv[i]});
  }
  return out;
}

}  // namespace dmise
