#include "core/effects/frame_effects.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

/// What is off beyond three widths of a source, in noise: there are rings or speckles of 0.003 of
/// a point's peak, smeared by the band; and by definition there is no background where a source
/// leaves more than half of the noise: twice that is left where rings are not smeared. An object
/// of many speckles evens them out. Two wavelengths leave rings that stand still as uneven as one.
double rings_in_noise(int level, const PlanFacts& f, double source_e, double size_px) {
  constexpr double of_rings[] = {2.0, 2.0, 1.1, 0.85, 0.0},
                   of_speckles[] = {2.0, 1.4, 1.0, 0.65, 0.0};
  constexpr double peak = 4.0, narrow = 0.5, half_noise = 0.5;
  const double width = f.relative_bandwidth / PsfWavelengths::count[std::size_t(level)];
  const double rings_e =
      0.003 * std::min(1.0, 10.0 * width) * f.ring_contrast * source_e * f.peak_share;
  const double across = narrow * size_px / f.speckle_px;
  const double speckles = f.screens * (1.0 + across * across);
  const double left = f.screens > 0 ? of_speckles[level] * std::min(1.0, peak / std::sqrt(speckles))
                                    : of_rings[level];
  return std::min(f.in_noise(rings_e), half_noise * left);
}

}  // namespace

ErrorBound PsfWavelengths::error(int level, const PlanFacts& f) {
  const double width = f.relative_bandwidth / count[std::size_t(level)];
  ErrorBound error = f.dimmed_by(0.02 * width);
  error.position_px = 0.0055 * width * f.fwhm_px;
  const double star = rings_in_noise(level, f, f.brightest_star_e, 0.0),
               object = rings_in_noise(level, f, f.brightest_object_e, f.narrowest_object_px);
  const double light_e = std::max(star, object) * f.least_noise_e();
  const ErrorBound beside = f.without_light([&](const SkySample&) { return light_e; });
  error.background_sigma = beside.background_sigma;
  error.noise = beside.noise;
  return error;
}

ErrorBound StarBackground::error(int level, const PlanFacts& f) {
  const double limit = limit_v_mag(level);
  const double left_e = level == 0 ? f.brightest_star_e : f.brightest_left_e[f.limit(limit)];
  const double starlight_e = f.starlight_e[f.limit(limit)];
  if (!(left_e > 0.0 || starlight_e > 0.0)) return {};
  // The brightest star that is left out, in its brightest pixel; and the smooth starlight that
  // stands for all of them.
  const double star = f.peak_in_noise(left_e * f.pattern_share(f.star_trail_px) / f.least_noise_e(),
                                      f.star_trail_px);
  const double light_e = std::max(star * f.least_noise_e(), starlight_e);
  ErrorBound error = f.without_light([&](const SkySample&) { return light_e; });
  // In the capsule of a source that counts.
  const double share = std::min(PlanFacts::neighbour_share, left_e / f.faintest_source_e());
  error.photometry_mag = 1.086 * share;
  // One that would count itself.
  if (left_e * f.pattern_share(f.star_trail_px) >= PlanFacts::least_snr * f.least_noise_e())
    error.photometry_mag = unbounded;
  error.position_px = 3.0 * share * std::hypot(1.0, f.fwhm_px);
  return error;
}

}  // namespace dmise
