#include "core/detection/source/line_profile.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/algebra/symmetric2.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr int neighbours = 20;  // on each side
constexpr int min_neighbours = 12;
constexpr double dark_odds = 25.0;   // logarithm, of a gap without light against light
constexpr double dark_share = 0.25;  // light that a gap may have, over the streak's
constexpr double dark_sigmas = 5.0;  // shorter gaps, in units of the PSF, may be the detector's

}  // namespace

Line principal_axis(const std::vector<Point>& points, const Line& line, double width_px) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (const Point& p : points) {
    if (std::abs(line.off(p)) > width_px) continue;
    const double dx = p.x - line.x, dy = p.y - line.y;
    const double w = p.weight;
    n += w;
    x += w * dx;
    y += w * dy;
    xx += w * dx * dx;
    xy += w * dx * dy;
    yy += w * dy * dy;
  }
  if (!(n > 0)) return line;
  x /= n;
  y /= n;
  const double angle = axis_angle_rad({xx / n - x * x, xy / n - x * y, yy / n - y * y});
  return {line.x + x, line.y + y, std::cos(angle), std::sin(angle)};
}

Slice slice_at(const Scene& scene, const Line& line, int major, double offset_px) {
  const Point centre = line.at(major, offset_px);
  const double sigma = scene.sigma_px, cosine = 1.0 / line.slice_px();
  const double middle = line.by_columns() ? centre.y : centre.x;
  const int reach = int(std::ceil(2.5 * sigma / cosine));
  double gd = 0.0, gg = 0.0, variance = 0.0;
  const int nearest = int(std::lround(middle));
  // A Gaussian in equal steps: each is the one before times a factor, which changes by a factor.
  const double step = cosine / sigma, first = (nearest - reach - middle) * step;
  const double change = std::exp(-step * step);
  double factor = std::exp(-step * (first + 0.5 * step));
  double next = std::exp(-0.5 * first * first) / (sigma * std::sqrt(2 * pi));
  for (int m = nearest - reach; m <= nearest + reach; ++m) {
    const double g = next;
    next *= factor;
    factor *= change;
    const int px = line.by_columns() ? major : m, py = line.by_columns() ? m : major;
    if (!scene.contains(px, py) || !scene.has_value(px, py) || scene.is_hidden(px, py)) continue;
    const FitPixel pixel = scene.pixel(px, py);
    gd += g * pixel.signal_e;
    gg += g * g;
    variance += g * g * (pixel.variance_e2 + std::max(pixel.signal_e, 0.0f));
  }
  // Less than half a profile inside the frame is not used.
  if (gg < 0.25 * cosine / (2 * sigma * std::sqrt(pi))) return {};
  return {gd / gg, variance / (gg * gg)};
}

std::vector<Slice> slices(const Scene& scene, const Line& line, int from, int to,
                          double offset_px) {
  std::vector<Slice> out;
  const Extent seen = in_frame(scene, line, {from, to});
  for (int k = seen.from; k <= seen.to; ++k) {
    const Slice s = slice_at(scene, line, k, offset_px);
    if (s.variance > 0) out.push_back(s);
  }
  return out;
}

double median_level(const std::vector<Slice>& s) {
  std::vector<double> levels;
  for (const Slice& slice : s) levels.push_back(slice.e_per_px);
  return levels.empty() ? 0.0 : middle_of(std::move(levels));
}

std::array<double, 2> clipped_mean(const std::vector<Slice>& s, double level) {
  double sum = 0.0, variance = 0.0;
  for (const Slice& slice : s) {
    sum += std::min(slice.e_per_px, 2 * level);
    variance += slice.variance;
  }
  if (s.empty() || !(variance > 0)) return {0.0, 0.0};
  return {sum / double(s.size()), sum / std::sqrt(variance)};
}

std::optional<Extent> dark_gap(const Scene& scene, const Line& line, const Extent& extent,
                               double level, double offset_px) {
  struct Run {
    double odds = 0.0, light = 0.0;
    int slices = 0, from = 0, to = 0;
  };
  Run run, best;
  const Extent seen = in_frame(scene, line, extent);
  for (int k = seen.from; k <= seen.to; ++k) {
    const Slice s = slice_at(scene, line, k, offset_px);
    if (!(s.variance > 0)) continue;
    if (run.slices == 0) run.from = k;
    const double e = std::clamp(s.e_per_px, -level, 2 * level);
    run.odds += level * (level / 2 - e) / s.variance;
    run.light += e;
    ++run.slices;
    run.to = k;
    if (run.odds <= 0)
      run = {};
    else if (run.odds > best.odds)
      best = run;
  }
  if (best.odds < dark_odds || best.light > dark_share * level * best.slices ||
      best.slices * line.slice_px() < dark_sigmas * scene.sigma_px)
    return std::nullopt;
  return Extent{best.from, best.to};
}

Trail trail_along(const Line& line, const Extent& extent, double level) {
  const Point a = line.at(extent.from - 0.5), b = line.at(extent.to + 0.5);
  Trail t;
  t.x_px = (a.x + b.x) / 2;
  t.y_px = (a.y + b.y) / 2;
  t.length_px = std::hypot(b.x - a.x, b.y - a.y);
  t.angle_rad = std::atan2(b.y - a.y, b.x - a.x);
  t.flux_e = level * t.length_px;
  t.sagitta_px = line.sagitta_px * std::pow(t.length_px / (2 * line.half_length_px), 2);
  // The ends lie beside the centroid of the light by two thirds of the bend.
  t.x_px -= 2.0 / 3 * t.sagitta_px * std::sin(t.angle_rad);
  t.y_px += 2.0 / 3 * t.sagitta_px * std::cos(t.angle_rad);
  return t;
}

double rise_above_neighbours(const Scene& scene, const Trail& trail, LineLight by) {
  const Line line = line_of(trail);
  const double level = trail.flux_e / trail.length_px;
  const Extent extent = extent_of(line, trail.length_px / 2);
  const auto own = slices(scene, line, extent.from, extent.to, 0.0);
  const auto light = [&](const std::vector<Slice>& on) {
    return by == LineLight::median ? median_level(on) : clipped_mean(on, level)[0];
  };
  const double step_px = 4 * scene.sigma_px;
  std::vector<double> beside;
  for (int k = -neighbours; k <= neighbours; ++k) {
    if (std::abs(k) < 2) continue;
    const auto other = slices(scene, line, extent.from, extent.to, k * step_px);
    if (2 * other.size() > own.size()) beside.push_back(light(other));
  }
  if (beside.size() < min_neighbours) return std::numeric_limits<double>::infinity();
  // Stars only add light, so upward scatter counts if it is larger.
  const double middle = middle_of(beside);
  const double upwards = (value_of_rank(beside, beside.size() * 9 / 10) - middle) / 1.2816;
  for (double& value : beside) value = std::abs(value - middle);
  const double scatter = std::max(1.4826 * middle_of(std::move(beside)), upwards);
  return (light(own) - middle) / std::max(scatter, 1e-12);
}

}  // namespace dmise
