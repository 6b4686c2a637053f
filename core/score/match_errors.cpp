#include "core/score/match_errors.h"

#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/units.h"
#include "core/frames/vec.h"
#include "core/score/matched_filter.h"
#include "core/score/trail.h"

namespace dmise {
namespace {

/// d' C^-1 d / 2; empty if the covariance is not positive definite.
std::optional<double> half_nees(double x, double y, const std::array<double, 3>& c) {
  const double determinant = c[0] * c[2] - c[1] * c[1];
  if (!(c[0] > 0.0 && determinant > 0.0)) return {};
  return 0.5 * (x * x * c[2] - 2.0 * x * y * c[1] + y * y * c[0]) / determinant;
}

void add_direction(MatchErrors& e, const ScoredTruth& t, const Detection& d) {
  if (!t.truth.ra_rad || !t.truth.dec_rad) return;
  const auto at = from_spherical<Gcrs>(*t.truth.ra_rad, *t.truth.dec_rad);
  const auto seen = from_spherical<Gcrs>(d.corrected_ra_rad, d.corrected_dec_rad);
  // The covariance is in the directions of east and north at the detection.
  const double ra = d.corrected_ra_rad, dec = d.corrected_dec_rad;
  const Vec<Gcrs> east{-std::sin(ra), std::cos(ra), 0.0};
  const Vec<Gcrs> north{-std::cos(ra) * std::sin(dec), -std::sin(ra) * std::sin(dec),
                        std::cos(dec)};
  const double x = dot(seen - at, east), y = dot(seen - at, north);
  e.nees_sky = half_nees(x, y, d.covariance_rad2);
  if (t.is_point()) {
    e.along_arcsec = x / arcsec;
    e.across_arcsec = y / arcsec;
  } else if (d.kind == DetectionKind::streak) {
    const double s = std::sin(d.position_angle_rad), c = std::cos(d.position_angle_rad);
    e.along_arcsec = (x * s + y * c) / arcsec;
    e.across_arcsec = (y * s - x * c) / arcsec;
  }
}

void add_ends(MatchErrors& e, const ScoredTruth& t, const Detection& d, const TrueTrail& trail) {
  if (t.is_point() || !t.truth.whole || d.kind != DetectionKind::streak) return;
  auto first = trail.nearest({d.end1_x_px, d.end1_y_px});
  auto second = trail.nearest({d.end2_x_px, d.end2_y_px});
  SimTime first_time = d.end1_time, second_time = d.end2_time;
  if (first.along_px > second.along_px) {
    std::swap(first, second);
    // The times belong to the ends only if the direction is known.
    if (d.direction_known) std::swap(first_time, second_time);
  }
  e.start_along_px = -first.along_px;
  e.start_across_px = first.across_px;
  e.end_along_px = second.along_px - trail.length_px();
  e.end_across_px = second.across_px;
  if (!t.truth.start_time || !t.truth.end_time) return;
  const double exposure_s = (*t.truth.end_time - *t.truth.start_time).seconds();
  e.start_time_s = (first_time - *t.truth.start_time).seconds() - first.u * exposure_s;
  e.end_time_s = (second_time - *t.truth.start_time).seconds() - second.u * exposure_s;
}

/// Whether a band is V by its name, as "bessell-V": truth has magnitudes of no other.
bool is_visual(std::string_view band) {
  return band == "V" || band.ends_with("-V") || band.ends_with(" V") || band.ends_with("_V");
}

}  // namespace

MatchErrors errors_of(const ScoredTruth& t, const Detection& d, const ScoredFrame& frame) {
  MatchErrors e;
  const TrueTrail trail(t.truth.start, t.truth.middle, t.truth.end);
  const PixelPosition off = PixelPosition{d.x_px, d.y_px} - *t.truth.light;
  const PixelPosition along =
      t.is_point() ? PixelPosition{1.0, 0.0} : trail.direction(trail.nearest(*t.truth.light).u);
  e.along_px = off.x_px * along.x_px + off.y_px * along.y_px;
  e.across_px = off.y_px * along.x_px - off.x_px * along.y_px;
  e.nees_px = half_nees(off.x_px, off.y_px, d.covariance_px2);
  if (t.truth.signal_e && frame.noise_e && frame.sigma_px)
    e.over_bound = *e.across_px / position_bound_px({*t.truth.signal_e, t.length_px, *frame.noise_e,
                                                     *frame.sigma_px});
  add_direction(e, t, d);
  if (t.truth.magnitude && (is_visual(d.band) || !t.truth.start_time)) {
    e.magnitude = d.magnitude - frame.solar_colour_mag - *t.truth.magnitude;
    if (d.magnitude_sigma > 0.0) e.magnitude_over_sigma = *e.magnitude / d.magnitude_sigma;
  }
  if (t.truth.signal_e && d.signal_e > 0.0) {
    e.flux = -2.5 * std::log10(d.signal_e / *t.truth.signal_e);
    if (d.magnitude_sigma > 0.0) e.flux_over_sigma = *e.flux / d.magnitude_sigma;
  }
  add_ends(e, t, d, trail);
  return e;
}

}  // namespace dmise
