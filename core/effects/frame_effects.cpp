#include "core/effects/frame_effects.h"

#include <algorithm>
#include <cmath>

#include "core/effects/plan_facts.h"

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

/// Error among the speckles of an object of `size_px`, which even out if they are many.
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

/// Error on uncut patches of 32 px [e-]: relative, by the square of the size of a patch in radians,
/// 8 times that for the zodiacal light, whose table is a cubic between its nodes, and as much as
/// the square of a patch over the way to the Sun; 1.5 times for the other parts. These steepen
/// towards the horizon as the airmass and twilight towards the Sun: there the error is of the third
/// power of a patch over the way to them. Moonlight has a kink 9 deg from the Moon and rises
/// towards it; clouds have edges.
double of_patches(const SkySample& s, const PlanFacts& f) {
  // The Earth's edge, and the air over it, are narrower than patches.
  const bool sees_edge = f.sees_horizon && !f.scene.on_ground;
  if (sees_edge || std::isfinite(f.cloud_detail_px)) return s.sky_e;
  constexpr double beyond_kink_rad = 0.2, third_order = 0.05, nearest_sun_rad = 1.0 * deg;
  const double patch_rad = 32.0 * std::max(f.pixel_rad, f.widest_pixel_rad);
  const double zodiacal_e = s.of(SkyPart::zodiacal_light);
  const auto steep = [&](double way_rad) {
    return std::min(1.0, third_order * std::pow(patch_rad / way_rad, 3));
  };
  const double sun_rad = std::max(nearest_sun_rad, f.nearest_sun_rad),
               over_sun = patch_rad / sun_rad;
  double missed_e = std::min(1.0, 8.0 * patch_rad * patch_rad + over_sun * over_sun) * zodiacal_e +
                    1.5 * patch_rad * patch_rad * (s.sky_e - zodiacal_e) +
                    steep(sun_rad) * (s.of(SkyPart::twilight) + s.of(SkyPart::daylight));
  // More than twilight's smooth slope at the zenith needs.
  constexpr double tip = 0.3, mag_per_rad = 0.16;
  if (f.sees_zenith)
    missed_e += tip * patch_rad * mag_per_rad / std::max(f.zenith_extinction_mag, 0.05) *
                s.of(SkyPart::twilight);
  if (f.scene.on_ground) missed_e += steep(1.0 / f.max_airmass) * s.sky_e;
  if (f.nearest_moon_rad < beyond_kink_rad) {
    const double rises = patch_rad / f.nearest_moon_rad;
    missed_e += std::min(1.0, 1.3 * patch_rad + rises * rises) * f.moonlight_e(s);
  }
  return missed_e;
}

/// Bound of the error that cutting leaves [e-]. Cutting does not find pieces of cloud that are
/// smaller than a patch.
double of_cut(int level, const SkySample& s, const PlanFacts& f) {
  constexpr double smallest_px = 64.0;
  // Twilight has up to twice the error that is asked for (SkyLayer.EachLevelOfTheGrid..).
  const double bends = 1.0 + s.of(SkyPart::twilight) / std::max(s.sky_e, 1e-300);
  const double share = f.cloud_detail_px < smallest_px ? 1.0 : 1.2 * bends * SkyGrid::asked(level);
  const double brightest_e =
      PlanFacts::usual_between * (s.sky_e - s.of(SkyPart::scattered_moonlight) + f.moonlight_e(s));
  return share * std::min(brightest_e, (1.0 + share) * f.saturated_e);
}

}  // namespace

ErrorBound SkyBackground::error(int, const PlanFacts& f) {
  return f.without_light([](const SkySample& s) { return 1.1 * s.sky_e; });
}

double SkyBackground::cost_s(int level, const PlanFacts& f) { return level * 0.9e-9 * f.pixels(); }

ErrorBound SpaceObjects::error(int, const PlanFacts& f) {
  return f.objects > 0 ? not_bounded : ErrorBound{};
}

double SpaceObjects::cost_s(int level, const PlanFacts& f) {
  return level * (20e-6 * double(f.objects - f.shapes) + 1e-3 * double(f.shapes));
}

ErrorBound ResolvedShapes::error(int level, const PlanFacts& f) {
  double largest_px = 0.0;  // among shapes drawn as points
  for (const double radius_px : f.shape_radius_px)
    if (radius_px <= tolerance_px[std::size_t(level)]) largest_px = std::max(largest_px, radius_px);
  return f.shifted_objects(largest_px * f.pixel_rad);
}

double ResolvedShapes::cost_s(int level, const PlanFacts& f) {
  constexpr double shape_s = 38e-3;
  return shape_s * double(std::ranges::count_if(f.shape_radius_px, [&](double radius_px) {
           return radius_px > tolerance_px[std::size_t(level)];
         }));
}

double StarBackground::cost_s(int level, const PlanFacts& f) {
  constexpr double search_s = 20e-6, star_s = 1.4e-6;
  if (level == 0) return 0.0;
  return search_s +
         star_s * (level == facts.reference() ? f.stars : f.stars_to(limit_v_mag(level)));
}

double SyntheticBackground::cost_s(int level, const PlanFacts& f) {
  constexpr double star_s = 0.7e-6;
  const double limit = limit_v_mag(level);
  return level == 0 ? 0.0 : star_s * f.synthetic_brighter[PlanFacts::limit(limit)];
}

ErrorBound SkyGrid::error(int level, const PlanFacts& f) {
  return f.without_light(
      [&](const SkySample& s) { return std::min(of_cut(level, s, f), of_patches(s, f)); });
}

double SkyGrid::cost_s(int level, const PlanFacts& f) {
  constexpr std::array<double, 4> looks_more{0.0, 0.05, 4.0, 20.0};
  if (level == facts.reference()) return f.sky_look_s * f.pixels();
  const bool is_cut = std::any_of(f.sky.begin(), f.sky.end(), [&](const SkySample& s) {
    return of_patches(s, f) > of_cut(level, s, f);
  });
  return is_cut ? looks_more[std::size_t(level)] * f.sky_look_s * f.sky_looks() : 0.0;
}

int PsfWavelengths::wavelengths(int level, const PlanFacts& f) {
  return std::max(count[std::size_t(level)], f.min_wavelengths);
}

double PsfWavelengths::cost_s(int level, const PlanFacts& f) {
  const int wavelengths = PsfWavelengths::wavelengths(level, f);
  return f.kernel_s * (f.kernels_change ? wavelengths - 1.0 : 0.01 * wavelengths);
}

ErrorBound Occlusion::error(int, const PlanFacts& f) {
  return f.shapes > 0 ? not_bounded : ErrorBound{};
}

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
  const double light_e = beside_sources * f.min_noise_e();
  const ErrorBound beside = f.without_light([&](const SkySample&) { return light_e; });
  error.background_sigma = beside.background_sigma;
  error.noise = beside.noise;
  return error;
}

ErrorBound StarBackground::error(int level, const PlanFacts& f) {
  const double limit = limit_v_mag(level);
  const double left_e = level == 0 ? f.brightest_star_e : f.brightest_left_e[f.limit(limit)];
  const double starlight_e = f.starlight_e[f.limit(limit)];
  // Stars beyond the catalogue are drawn only where it is drawn to its end.
  const bool cut = f.synthetic_brighter[f.limit(limit)] == 0.0;
  const ErrorBound beyond = cut ? SyntheticBackground::error(0, f) : ErrorBound{};
  if (!(left_e > 0.0 || starlight_e > 0.0)) return beyond;
  // The brightest star that is left out, in its brightest pixel; and the smooth starlight that
  // stands for all of them.
  const double star =
      f.peak_in_noise(left_e * f.pattern_share(f.star_trail_px) / f.min_noise_e(), f.star_trail_px);
  const double light_e = std::max(star * f.min_noise_e(), starlight_e);
  ErrorBound error = f.without_light([&](const SkySample&) { return light_e; });
  // In the capsule of a source that counts.
  const double share = std::min(PlanFacts::neighbour_share, left_e / f.faintest_source_e());
  error.photometry_mag = 1.086 * share;
  // One that would count itself.
  if (left_e * f.pattern_share(f.star_trail_px) >= PlanFacts::min_snr * f.min_noise_e())
    error.photometry_mag = unbounded;
  error.position_px = 3.0 * share * std::hypot(1.0, f.fwhm_px);
  return error + beyond;
}

bool SyntheticBackground::is_seen(double signal_e, const PlanFacts& f) {
  constexpr double seen_snr = 2.5;
  return signal_e * f.pattern_share(f.star_trail_px) / f.min_noise_e() >= seen_snr;
}

int SyntheticBackground::whole_level(const PlanFacts& f) {
  int level = 0;
  while (level < facts.reference() && f.synthetic_left_e[f.limit(limit_v_mag(level))] > 0.0)
    ++level;
  return level;
}

ErrorBound SyntheticBackground::error(int level, const PlanFacts& f) {
  // Their light is there, smooth: what is missing is stars that can be seen one by one.
  const double left_e = f.synthetic_left_e[f.limit(limit_v_mag(level))];
  if (!(left_e > 0.0)) return {};
  const double share = std::min(PlanFacts::neighbour_share, left_e / f.faintest_source_e());
  return {.photometry_mag = is_seen(left_e, f) ? unbounded : 1.086 * share,
          .position_px = 3.0 * share * std::hypot(1.0, f.fwhm_px)};
}

}  // namespace dmise
