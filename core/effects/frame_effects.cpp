#include "core/effects/frame_effects.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

/// Error of a fringe by `count` wavelengths instead of the whole band, relative to its amplitude:
/// they leave sin(phase) / (n sin(phase / n)) of it, the band sin(phase) / phase. `phase_rad`: the
/// difference in phase between the ends of the band.
double of_fringe(int count, double phase_rad) {
  if (phase_rad < 1e-3) return 0.0;
  const double step_rad = phase_rad / count;
  if (step_rad >= pi) return 1.0;
  const double left = 1.0 / (count * std::sin(step_rad)), smeared = 1.0 / phase_rad;
  const double missed = step_rad < pi / 2 ? left - smeared : left + smeared;
  return std::min(1.0, std::min(1.0, phase_rad) * missed);
}

/// Error of the light among the rings of a source, beyond three of its widths, in units of the
/// noise. By definition there is no background where a source leaves more than half of the noise.
/// At a distance r the ends of the band are r / airy x bandwidth of a ring apart.
double rings_in_noise(int count, const PlanFacts& f, double source_e) {
  constexpr int radii = 12;
  constexpr double half_noise = 0.5, brighter = 4.0;  // rings than their mean, with spikes
  const double left = count < 3 ? 2.6 : count < 5 ? 1.2 : 1.0;  // two are as uneven as one
  if (!std::isfinite(f.kernel_end_px) || !(source_e > 0.0)) return 0.0;
  const double source = f.in_noise(brighter * f.ring_contrast * source_e * f.kernel_end_share);
  const double nearest_px = std::min(f.kernel_end_px, 3.0 * std::hypot(1.0, f.fwhm_px));
  const double step = std::pow(f.kernel_end_px / nearest_px, 1.0 / (radii - 1));
  double largest = 0.0, r_px = nearest_px;
  for (int i = 0; i < radii; ++i, r_px *= step) {
    const double ends = f.kernel_end_px / r_px,
                 light = std::min(half_noise, source * ends * ends * ends);
    const double phase_rad = pi * f.relative_bandwidth * r_px / f.airy_px;
    largest = std::max(largest, 2.0 * light *
                                    (of_fringe(count, phase_rad) +
                                     of_fringe(PsfWavelengths::count.back(), phase_rad)));
  }
  return std::min(largest, half_noise * left);
}

/// The same among the speckles of an object of `size_px`, which even out if they are many.
double speckles_in_noise(int level, const PlanFacts& f, double source_e, double size_px) {
  constexpr double of_speckles[] = {2.6, 1.5, 1.1, 0.75, 0.0};
  constexpr double peak = 4.0, narrow = 0.5, half_noise = 0.5;
  const double width = f.relative_bandwidth / PsfWavelengths::wavelengths(level, f);
  const double light_e =
      0.003 * std::min(1.0, 10.0 * width) * f.ring_contrast * source_e * f.peak_share;
  const double across = narrow * size_px / f.speckle_px;
  const double speckles = f.screens * (1.0 + across * across);
  const double left = of_speckles[level] * std::min(1.0, peak / std::sqrt(speckles));
  return std::min(f.in_noise(light_e), half_noise * left);
}

}  // namespace

ErrorBound PsfWavelengths::error(int level, const PlanFacts& f) {
  const int n = wavelengths(level, f);
  if (n >= count.back()) return {};
  const double width = f.relative_bandwidth / n;
  ErrorBound error = f.dimmed_by(0.02 * width);
  // Without speckles the rings of a neighbour may be in a source's aperture.
  error.position_px = (f.screens > 0 ? 0.0055 : 0.02) * width * f.fwhm_px;
  const double beside_sources =
      f.screens > 0
          ? std::max(speckles_in_noise(level, f, f.brightest_star_e, 0.0),
                     speckles_in_noise(level, f, f.brightest_object_e, f.narrowest_object_px))
          : rings_in_noise(n, f, f.brightest_e());
  const double light_e = beside_sources * f.least_noise_e();
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

ErrorBound SyntheticBackground::error(int level, const PlanFacts& f) {
  // Their light is there, smooth: what is missing is stars that can be seen one by one.
  constexpr double seen_snr = 2.5;
  const double left_e = f.synthetic_left_e[f.limit(limit_v_mag(level))];
  if (!(left_e > 0.0)) return {};
  const double snr = left_e * f.pattern_share(f.star_trail_px) / f.least_noise_e();
  const double share = std::min(PlanFacts::neighbour_share, left_e / f.faintest_source_e());
  return {.photometry_mag = snr >= seen_snr ? unbounded : 1.086 * share,
          .position_px = 3.0 * share * std::hypot(1.0, f.fwhm_px)};
}

}  // namespace dmise
