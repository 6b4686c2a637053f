#include "core/astrometry/source_measure.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/numeric/quantile.h"

namespace dmise {

double trail_length_px(const SourceMoments& m, double sigma_px) {
  const double major = m.major_sigma();
  return std::sqrt(12 * std::max(0.0, major * major - sigma_px * sigma_px));
}

bool SourceMeasure::is_saturated(const Component& c) const {
  for (const Run& run : c.runs)
    for (int x = run.first_x; x <= run.last_x; ++x)
      if (saturated(x, run.y)) return true;
  return false;
}

double SourceMeasure::light_e(const Component& c) const {
  double sum = 0.0;
  for (const Run& run : c.runs)
    for (int x = run.first_x; x <= run.last_x; ++x) sum += signal_e(x, run.y);
  return sum;
}

std::optional<SourceMoments> SourceMeasure::moments(const Component& c, double sigma_px) const {
  SourceMoments m = of_component(c, sigma_px);
  for (int step = 0; step < 20; ++step) {
    const SourceMoments before = m;
    if (!improve(m)) return std::nullopt;
    if (std::abs(m.x - before.x) + std::abs(m.y - before.y) < 1e-4 &&
        std::abs(m.xx - before.xx) + std::abs(m.yy - before.yy) < 1e-3 * m.mean())
      break;
  }
  if (m.x < c.min_x - 1 || m.x > c.max_x + 1 || m.y < c.min_y - 1 || m.y > c.max_y + 1)
    return std::nullopt;
  return m;
}

SourceMoments SourceMeasure::of_component(const Component& c, double sigma_px) const {
  SourceMoments m;
  double sum = 0.0;
  for (const Run& run : c.runs)
    for (int x = run.first_x; x <= run.last_x; ++x) {
      const double light = std::max(0.0, signal_e(x, run.y));
      sum += light;
      m.x += light * x;
      m.y += light * run.y;
      m.xx += light * x * x;
      m.yy += light * run.y * run.y;
      m.xy += light * x * run.y;
    }
  sum = std::max(sum, 1e-9);
  m.x /= sum;
  m.y /= sum;
  const double least = sigma_px * sigma_px;
  m.xx = std::max(m.xx / sum - m.x * m.x, least);
  m.yy = std::max(m.yy / sum - m.y * m.y, least);
  m.xy = std::clamp(m.xy / sum - m.x * m.y, -0.9 * std::sqrt(m.xx * m.yy),
                    0.9 * std::sqrt(m.xx * m.yy));
  return m;
}

bool SourceMeasure::improve(SourceMoments& m) const {
  constexpr double longest_trail_px = 200.0;
  const Symmetric2 spread = m.spread();
  if (!(determinant(spread) > 1e-4) || m.mean() > longest_trail_px * longest_trail_px) return false;
  const Symmetric2 weights = inverse_of(spread);
  const int wide = int(std::ceil(3.5 * std::sqrt(m.xx))) + 1,
            high = int(std::ceil(3.5 * std::sqrt(m.yy))) + 1;
  const int cx = int(std::lround(m.x)), cy = int(std::lround(m.y));
  double sum = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  for (int y = std::max(0, cy - high); y <= std::min(counts_.rows - 1, cy + high); ++y)
    for (int x = std::max(0, cx - wide); x <= std::min(counts_.columns - 1, cx + wide); ++x) {
      const double dx = x - m.x, dy = y - m.y;
      const double d2 = quadratic_form(weights, dx, dy);
      if (d2 > 12.25) continue;
      const double light = std::exp(-0.5 * d2) * signal_e(x, y);
      sum += light;
      sx += light * dx;
      sy += light * dy;
      sxx += light * dx * dx;
      sxy += light * dx * dy;
      syy += light * dy * dy;
    }
  if (!(sum > 0)) return false;
  sx /= sum;
  sy /= sum;
  m.x += 2 * sx;
  m.y += 2 * sy;
  m.xx = std::max(2 * (sxx / sum - sx * sx), min_variance_px2);
  m.yy = std::max(2 * (syy / sum - sy * sy), min_variance_px2);
  m.xy = 2 * (sxy / sum - sx * sy);
  m.flux = 2 * sum;  // the weight halves a Gaussian's light
  return std::isfinite(m.x + m.y) && contains(int(std::lround(m.x)), int(std::lround(m.y)));
}

/// The place is the middle of the light that is left; the flux is by the pixels just outside the
/// clipped ones.
PlateSource SourceMeasure::saturated_source(const Component& c, double sigma_px,
                                            double length_px) const {
  const SourceMoments m = of_component(c, sigma_px);
  const Trail unit{
      .x_px = m.x, .y_px = m.y, .flux_e = 1.0, .length_px = length_px, .angle_rad = m.angle_rad()};
  std::vector<double> fluxes;
  for (int y = std::max(0, c.min_y - 1); y <= std::min(counts_.rows - 1, c.max_y + 1); ++y)
    for (int x = std::max(0, c.min_x - 1); x <= std::min(counts_.columns - 1, c.max_x + 1); ++x) {
      if (saturated(x, y)) continue;
      bool beside = false;
      for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
        beside = beside || (contains(x + dx, y + dy) && saturated(x + dx, y + dy));
      if (beside)
        fluxes.push_back(signal_e(x, y) / std::max(trail_value(unit, sigma_px, x, y), 1e-6));
    }
  const double light = light_e(c);
  const double flux = fluxes.empty() ? light : std::max(light, median_of(fluxes));
  return {m.x, m.y, flux, {0.25 * m.xx, 0.25 * m.xy, 0.25 * m.yy}, flux, true};
}

std::optional<TrailFit> SourceMeasure::fit(const SourceMoments& m, double sigma_px) const {
  const double length = trail_length_px(m, sigma_px);
  const bool trail = length > 2 * sigma_px;
  Trail start{.x_px = m.x, .y_px = m.y, .flux_e = std::max(m.flux, 1.0)};
  if (trail) {
    start.length_px = length;
    start.angle_rad = m.angle_rad();
  } else if (settings_.motion) {
    const PixelPosition moved = settings_.motion->trail_at({m.x, m.y});
    start.length_px = std::hypot(moved.x_px, moved.y_px);
    start.angle_rad = std::atan2(moved.y_px, moved.x_px);
  }
  std::vector<FitPixel> pixels;
  const double c = std::cos(start.angle_rad), s = std::sin(start.angle_rad);
  const double across = 3 * sigma_px + 0.7, along = across + 0.6 * start.length_px;
  const int reach = int(std::ceil(along)) + 1;
  const int cx = int(std::lround(m.x)), cy = int(std::lround(m.y));
  for (int y = cy - reach; y <= cy + reach; ++y)
    for (int x = cx - reach; x <= cx + reach; ++x) {
      const double dx = x - m.x, dy = y - m.y;
      if (!contains(x, y) || std::abs(dx * c + dy * s) > along ||
          std::abs(dy * c - dx * s) > across)
        continue;
      const double noise = noise_e(x, y);
      pixels.push_back({x, y, float(signal_e(x, y)), float(noise * noise)});
    }
  if (pixels.size() < 12) return std::nullopt;
  // The background's error, as far as a mesh cell can hide it.
  const double prior_e = 0.3 * std::sqrt(double(pixels[0].variance_e2));
  const FitSettings fit_settings{.psf = sigma_px, .background_sigma_e = prior_e};
  TrailFit fit = fit_trails(pixels, {start}, {trail ? trail_line : trail_place}, fit_settings);
  if (!fit.converged) fit = fit_trails(pixels, {start}, {trail_place}, fit_settings);
  if (!fit.converged) return std::nullopt;
  return fit;
}

std::optional<PlateSource> SourceMeasure::source(const SourceMoments& m, double sigma_px) const {
  const auto fitted = fit(m, sigma_px);
  if (!fitted) return std::nullopt;
  const TrailFit& fit = *fitted;
  const Trail& t = fit.trails[0];
  if (!(t.flux_e > 0) || std::hypot(t.x_px - m.x, t.y_px - m.y) > 2 * m.major_sigma() ||
      !std::isfinite(fit.cov(0, 0) + fit.cov(1, 1)))
    return std::nullopt;
  const double scale = std::max(1.0, fit.reduced_chi2());
  const double flux_sigma = std::sqrt(scale * fit.cov(2, 2));
  if (t.flux_e < settings_.min_snr * flux_sigma) return std::nullopt;
  return PlateSource{
      t.x_px,     t.y_px,
      t.flux_e,   {scale * fit.cov(0, 0), scale * fit.cov(0, 1), scale * fit.cov(1, 1)},
      flux_sigma, false};
}

}  // namespace dmise
