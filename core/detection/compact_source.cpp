#include "core/detection/compact_source.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/units.h"
#include "core/detection/source_fit.h"
#include "core/detection/star_hypothesis.h"

namespace dmise {
namespace {

struct Light {
  std::vector<FitPixel> usable;   // pixels to fit
  std::vector<FitPixel> clipped;  // saturated
};

/// Pixels of a component and their neighbours.
Light light_around(const Scene& scene, const Component& component) {
  std::map<int, std::vector<std::pair<int, int>>> rows;
  for (const Run& run : component.runs)
    for (int y = run.y - 1; y <= run.y + 1; ++y)
      if (y >= 0 && y < scene.counts.rows)
        rows[y].push_back(
            {std::max(0, run.first_x - 1), std::min(scene.counts.columns - 1, run.last_x + 1)});
  Light out;
  for (auto& [y, spans] : rows) {
    std::sort(spans.begin(), spans.end());
    int done = -1;
    for (const auto& [first, last] : spans)
      for (int x = std::max(first, done + 1); x <= last; ++x) {
        done = x;
        if (!scene.has_value(x, y)) continue;
        (scene.is_usable(x, y) ? out.usable : out.clipped).push_back(scene.pixel(x, y));
      }
  }
  return out;
}

/// Moments of the light: centroid, and the uniform trail of the same spread.
Trail moments(const std::vector<FitPixel>& pixels, double sigma_px) {
  double f = 0, x = 0, y = 0;
  for (const auto& p : pixels) {
    const double w = std::max(p.signal_e, 0.0f);
    f += w;
    x += w * p.x;
    y += w * p.y;
  }
  if (!(f > 0)) return {};
  x /= f;
  y /= f;
  double xx = 0, xy = 0, yy = 0, total = 0;
  for (const auto& p : pixels) {
    const double w = std::max(p.signal_e, 0.0f) / f, dx = p.x - x, dy = p.y - y;
    xx += w * dx * dx;
    xy += w * dx * dy;
    yy += w * dy * dy;
    total += p.signal_e;
  }
  Trail trail;
  trail.x_px = x;
  trail.y_px = y;
  trail.flux_e = std::max(total, 1.0);
  trail.angle_rad = 0.5 * std::atan2(2 * xy, xx - yy);
  const double major = 0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy);
  trail.length_px = std::sqrt(12 * std::max(major - sigma_px * sigma_px, 0.1));
  return trail;
}

/// Relative error of the PSF outside `clipped` pixels.
double wings_error(std::size_t clipped, double sigma_px, const DetectorSettings& settings) {
  const double radius_in_sigmas = std::sqrt(double(clipped) / pi) / sigma_px;
  return std::clamp(settings.wings_error * radius_in_sigmas * radius_in_sigmas,
                    settings.least_wings_error, settings.most_wings_error);
}

/// Fits the wings alone. The flux is that of the wings times a factor given by the PSF, with an
/// error of 0.01 for each square of the sigma at which they begin (2 ln of peak over clip).
std::optional<Source> from_wings(const Scene& scene, const Trail& start, bool streak,
                                 const std::vector<FitPixel>& clipped, double model_error) {
  auto source = fit_source(scene, start, streak, 0.3 * model_error);
  if (!source) return source;
  source->model_error = model_error;
  double excess = 1.0;
  for (const FitPixel& p : clipped)
    excess = std::max(excess, trail_value(source->trail(), scene.sigma_px, p.x, p.y) /
                                  std::max(double(p.signal_e), 1.0));
  const double flux_error_e = 0.02 * std::log(excess) * source->trail().flux_e;
  source->fit.covariance[2 * std::size_t(source->fit.parameters) + 2] +=
      flux_error_e * flux_error_e;
  return source;
}

/// Whether the source would clip a pixel that is clipped; wings alone are ambiguous.
bool explains_saturation(const Scene& scene, const Source& source,
                         const std::vector<FitPixel>& clipped) {
  return std::any_of(clipped.begin(), clipped.end(), [&](const FitPixel& p) {
    return trail_value(source.trail(), scene.sigma_px, p.x, p.y) > 0.7 * p.signal_e;
  });
}

}  // namespace

std::optional<Source> judge_compact(const Scene& scene, const Component& component,
                                    const DetectorSettings& settings) {
  const Light around = light_around(scene, component);
  const std::vector<FitPixel>& pixels = around.usable;
  const std::vector<FitPixel>& clipped = around.clipped;
  if (pixels.size() < 8) return std::nullopt;
  const bool saturated = !clipped.empty();
  std::vector<FitPixel> all = pixels;
  all.insert(all.end(), clipped.begin(), clipped.end());
  const Trail light = moments(all, scene.sigma_px);
  const double model_error =
      saturated ? wings_error(clipped.size(), scene.sigma_px, settings) : settings.model_error;
  Trail star = scene.star_trail(light.x_px, light.y_px);
  star.flux_e = light.flux_e;
  FitSettings fit_settings;
  fit_settings.sigma_px = scene.sigma_px;
  fit_settings.model_error = model_error;
  fit_settings.settled_chi2 = 0.05;  // small compared to every margin
  fit_settings.most_steps = 8;
  constexpr double surely_star_sigmas = 0.5;
  fit_settings.good_enough_sigmas = surely_star_sigmas;
  const TrailFit as_star = fit_trails(pixels, {star}, {trail_place}, fit_settings);
  if (as_star.good(surely_star_sigmas)) return std::nullopt;
  fit_settings.good_enough_sigmas = std::nullopt;
  const bool stars_trail = star.length_px >= settings.least_difference_px;
  TrailFit as_point;
  if (stars_trail) {
    Trail point = light;  // not from the fitted star trail, which may lie anywhere along it
    point.length_px = 0.0;
    as_point = fit_trails(pixels, {point}, {trail_place}, fit_settings);
  }
  const bool may_be_point =
      stars_trail && as_point.deviance < as_star.deviance - settings.blend_margin;
  if (as_star.good(3.5) && !may_be_point) return std::nullopt;

  const auto believable = [&](const std::optional<Source>& source) {
    return source && source->snr() >= settings.least_snr &&
           (!saturated || explains_saturation(scene, *source, clipped));
  };
  const auto fitted = [&](const Trail& start, bool streak) {
    return saturated ? from_wings(scene, start, streak, clipped, model_error)
                     : fit_source(scene, start, streak, 0.0);
  };
  fit_settings.most_steps = 15;
  const TrailFit as_line = fit_trails(pixels, {light}, {trail_line}, fit_settings);
  if (may_be_point && as_point.good(5.0) &&
      as_point.deviance < as_line.deviance + settings.blend_margin) {
    auto source = fitted(as_point.trails[0], false);
    // A star cut by the frame's edge looks like a point.
    if (believable(source) && !source->at_edge && point_beats_star(scene, *source, settings))
      return source;
    return std::nullopt;
  }
  if (!as_line.good(4.0) || as_line.deviance > as_star.deviance - 2 * settings.blend_margin ||
      !plausible(scene, as_line.trails[0]) || as_line.trails[0].length_px < 1.0)
    return std::nullopt;
  const double as_two = deviance_of_stars(pixels, light, star, 2, fit_settings);
  if (as_line.deviance > as_two - settings.blend_margin) return std::nullopt;
  auto source = fitted(as_line.trails[0], true);
  if (!believable(source)) return std::nullopt;
  const double sigma_length_px = std::sqrt(source->fit.cov(3, 3));
  const double tolerance_px = std::max(settings.least_difference_px, 4 * sigma_length_px);
  if (moves_like_star(*source, star, tolerance_px) || !beats_stars(scene, *source, settings))
    return std::nullopt;
  return source;
}

}  // namespace dmise
