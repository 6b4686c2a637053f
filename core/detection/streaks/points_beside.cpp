#include "core/detection/streaks/points_beside.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/detection/pixels/detection_limits.h"
#include "core/detection/source/source_fit.h"

namespace dmise {
namespace {

constexpr std::array shares{0.5, 0.2, 0.8};  // light of the first point over both, where fits begin
constexpr double max_chi2_of_pair = 2.0;     // reduced
constexpr double min_share = 0.02;           // light of the fainter over both
constexpr std::size_t min_pixels = 12;
constexpr int rounds = 3;

/// Two points with the middle and the spread of a uniform trail.
std::vector<Trail> start_of(const Trail& light, double share) {
  const double sigma_px = light.length_px / std::sqrt(12.0);
  const double apart_px = sigma_px / std::sqrt(share * (1 - share));
  const PixelPosition first = light.at(-(1 - share) * apart_px);
  const PixelPosition second = light.at(share * apart_px);
  return {{.x_px = first.x_px, .y_px = first.y_px, .flux_e = share * light.flux_e},
          {.x_px = second.x_px, .y_px = second.y_px, .flux_e = (1 - share) * light.flux_e}};
}

/// The straight line from one point to the other.
Trail line_between_points(const Trail& a, const Trail& b) {
  return {.x_px = (a.x_px + b.x_px) / 2,
          .y_px = (a.y_px + b.y_px) / 2,
          .flux_e = a.flux_e + b.flux_e,
          .length_px = std::hypot(b.x_px - a.x_px, b.y_px - a.y_px),
          .angle_rad = std::atan2(b.y_px - a.y_px, b.x_px - a.x_px)};
}

}  // namespace

TwoPoints fit_as_two_points(const std::vector<FitPixel>& pixels, const Trail& light,
                            const FitSettings& settings) {
  TwoPoints best;
  for (const double share : shares) {
    TrailFit fit = fit_trails(pixels, start_of(light, share), {trail_place, trail_place}, settings);
    if (best.fit.trails.empty() || fit.deviance < best.fit.deviance) best.fit = std::move(fit);
  }
  std::copy_n(best.fit.trails.begin(), 2, best.points.begin());
  return best;
}

std::vector<Source> points_beside(const Scene& scene, const std::array<Trail, 2>& start) {
  std::vector<Trail> two(start.begin(), start.end());
  FitSettings settings;
  settings.max_steps = 30;
  TrailFit fit;
  for (int round = 0; round < rounds; ++round) {
    if (!plausible(scene, two[0]) || !plausible(scene, two[1])) return {};
    const Trail line = line_between_points(two[0], two[1]);
    const PixelPosition middle{line.x_px, line.y_px};
    const double sigma_px = scene.psf.sigma_at(middle);
    settings.psf = scene.psf.at(middle);
    // The last fit's covariance is that of the noise alone.
    settings.model_error = round + 1 < rounds ? detection_limits::model_error : 0.0;
    auto pixels = pixels_near(scene, line, 3 * sigma_px + 2.5);
    if (round > 0) pixels = without_outliers(pixels, two, fit.background_e, 0.15, settings.psf);
    if (pixels.size() < min_pixels) return {};
    settings.background_sigma_e = background_sigma_e(pixels.front());
    fit = fit_trails(pixels, two, {trail_place, trail_place}, settings);
    two = fit.trails;
    if (round + 2 == rounds && fit.reduced_chi2() > max_chi2_of_pair) return {};
  }
  const double light_e = two[0].flux_e + two[1].flux_e;
  std::vector<Source> out;
  for (std::size_t k = 0; k < 2; ++k) {
    Source source = part_of(fit, k, trail_place);
    if (!plausible(scene, source.trail()) || !(source.fit.cov(2, 2) > 0) ||
        source.trail().flux_e < min_share * light_e || source.snr() < detection_limits::min_snr)
      return {};
    set_flags(scene, source.trail(), source);
    out.push_back(std::move(source));
  }
  return out;
}

}  // namespace dmise
